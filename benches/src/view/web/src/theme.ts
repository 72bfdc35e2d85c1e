// Colours for light and dark backgrounds that colour-blind people can distinguish (Okabe & Ito
// 2008).

import { Color } from "three";

export interface Theme {
  dark: boolean;
  background: Color;
  moving: Color;
  fixed: Color;
  walls: Color;
  picked: Color;
  /** By State. */
  states: Color[];
  /** Lines of pairs whose spheres overlap and nothing more, and of volumes. */
  spheres: Color;
  volumes: Color;
  cells: Color;
  /** The two bodies of a counter-example. */
  pair: [Color, Color];
}

const darkness = matchMedia("(prefers-color-scheme: dark)");
const stillness = matchMedia("(prefers-reduced-motion: reduce)");

/** The colours of the style sheet, which the legend has too, for the system's setting. */
function read(dark: boolean): Theme {
  const style = getComputedStyle(document.documentElement);
  const colour = (name: string) => new Color(style.getPropertyValue(`--${name}`).trim());
  return {
    dark,
    background: colour("ground"),
    moving: colour("idle"),
    fixed: colour("fixed"),
    walls: colour("walls"),
    picked: colour("ink"),
    states: ["idle", "idle", "reported", "meets", "missed"].map(colour),
    spheres: colour("spheres"),
    volumes: colour("volumes"),
    cells: colour("cells"),
    pair: [colour("pair-0"), colour("pair-1")],
  };
}

const themes = new Map<boolean, Theme>();

/** The theme of the system's setting. */
export function theme(): Theme {
  const dark = darkness.matches;
  const known = themes.get(dark);
  if (known) return known;
  const made = read(dark);
  themes.set(dark, made);
  return made;
}

/** Whether the user prefers reduced motion. */
export function reducedMotion(): boolean {
  return stillness.matches;
}

/** Calls back whenever one of the two settings changes. */
export function onSettings(changed: () => void): void {
  darkness.addEventListener("change", changed);
  stillness.addEventListener("change", changed);
}

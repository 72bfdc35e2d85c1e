// Colours that the colour-blind tell apart (Okabe & Ito 2008) on light and on dark ground.

import { Color } from "three";

export interface Theme {
  dark: boolean;
  background: Color;
  moving: Color;
  fixed: Color;
  /** Bodies that have nothing to do with the picked one. */
  ghost: Color;
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

const hex = (text: string): Color => new Color(text);

const LIGHT: Theme = {
  dark: false,
  background: hex("#f6f7f9"),
  moving: hex("#b4bcc6"),
  fixed: hex("#7c8590"),
  ghost: hex("#e9ecf0"),
  walls: hex("#8a929c"),
  picked: hex("#000000"),
  states: ["#b4bcc6", "#b4bcc6", "#e69f00", "#0072b2", "#d5400a"].map(hex),
  spheres: hex("#8f98a3"),
  volumes: hex("#30363d"),
  cells: hex("#009e73"),
  pair: [hex("#1fa8a0"), hex("#8e3a9d")],
};

const DARK: Theme = {
  dark: true,
  background: hex("#12151a"),
  moving: hex("#6b7580"),
  fixed: hex("#454d57"),
  ghost: hex("#39414b"),
  walls: hex("#78828e"),
  picked: hex("#ffffff"),
  states: ["#6b7580", "#6b7580", "#e69f00", "#45a5e6", "#ff5a1f"].map(hex),
  spheres: hex("#6d7681"),
  volumes: hex("#c8d0d9"),
  cells: hex("#2fc79a"),
  pair: [hex("#4fd6cc"), hex("#d58be0")],
};

const darkness = matchMedia("(prefers-color-scheme: dark)");
const stillness = matchMedia("(prefers-reduced-motion: reduce)");

/** The theme of the system's setting. */
export function theme(): Theme {
  return darkness.matches ? DARK : LIGHT;
}

/** Whether the person wants things not to move by themselves. */
export function reducedMotion(): boolean {
  return stillness.matches;
}

/** Calls back whenever one of the two settings changes. */
export function onSettings(changed: () => void): void {
  darkness.addEventListener("change", changed);
  stillness.addEventListener("change", changed);
}

// The settings of the page to play with, and the scene that they name: the paper's.

export const SETTINGS = {
  bodies: "150",
  meshes: "paper",
  strategy: "s-dop-sequential",
  beside: "sphere",
  k: "18",
  interest: "0",
  frames: "1000",
  seed: "1",
  truth: "no",
};

export type Settings = typeof SETTINGS;

/** A mesh that was dropped onto the page. */
export const OWN = "own";

const SHAPES: Record<string, string[]> = {
  paper: ["mesh = \"spot.tri\"", "mesh = \"teapot.tri\"", "mesh = \"bunny-4k.tri\""],
  balls: ["shape = \"icosphere\""],
  [OWN]: ["mesh = \"own\""],
};

/** Reads the part of the page's address after "?". Unknown settings are left out. */
export function readSettings(search: string): Settings {
  const given = Object.fromEntries(new URLSearchParams(search));
  const known = Object.entries(SETTINGS).map(([name, value]) => [name, given[name] ?? value]);
  return Object.fromEntries(known) as Settings;
}

/**
 * The scene file. Four fifths of the bodies move, and the shapes share both parts, as in
 * `data/scenes/paper-150.toml`: the same number and seed give the same bodies. `own` is the name
 * of the dropped file.
 */
export function sceneFile(settings: Settings, own: string): string {
  const { bodies, strategy, k, interest, frames, seed } = settings;
  const shapes = (SHAPES[settings.meshes] ?? SHAPES.paper).map((shape) => shape.replace("\"own\"", JSON.stringify(own)));
  const moving = Math.round(0.8 * Number(bodies));
  const groups = [moving, Number(bodies) - moving].flatMap((all, fixed) =>
    shapes.map((shape, n) => {
      const count = Math.floor(all / shapes.length) + (n < all % shapes.length ? 1 : 0);
      if (count === 0) return "";
      return `[[bodies]]\n${shape}\ncount = ${count}\nradius = 1.0\n${fixed ? "static = true" : "speed = [0.5, 2.0]"}\n`;
    }),
  );
  return `name = "${settings.meshes}-${bodies}"
seed = ${seed}
frames = ${frames}
dt = 0.016666667
[box]
side = 16.1
${groups.join("")}
[effects]
motion = true
walls = "specular"
spin = { rate = [0.1, 1.0] }
[cull]
strategy = "${strategy}"
pairs = "all-pairs"
k = ${k}
axes = "principal"
overlap = "two-sided"
interest = [${interest}]
`;
}

// The panel next to the picture: numbers, switches, lists.

import { LAYERS, type Layer } from "./overlays.ts";
import { type Counts, type Pair, type Run, State } from "./run.ts";

/** The most rows of a list. If a body is picked, only its pairs are listed. */
const MAX_ROWS = 60;

/** The rows of the table. Tests read cells by these ids. */
const CELLS = ["nu", "nv", "hits", "reported", "true", "t"] as const;

export const LAYER_NAMES: Record<Layer, string> = {
  spheres: "spheres",
  ordops: "or-DOPs",
  boxes: "world boxes",
  pairs: "pairs as lines",
  cells: "grid cells",
};

/** CSS colour of a state. */
export const STATE_COLOURS: Record<State, string> = {
  [State.Idle]: "var(--idle)",
  [State.Spheres]: "var(--spheres)",
  [State.Reported]: "var(--reported)",
  [State.Meets]: "var(--meets)",
  [State.Missed]: "var(--missed)",
};

/** T's terms, in the order of the block `terms-…`. */
export const TERMS = [
  { name: "Nu·Cu", colour: "--update" },
  { name: "F", colour: "--find" },
  { name: "Nv·Cv", colour: "--test" },
];

const grouped = new Intl.NumberFormat("en");
const short = new Intl.NumberFormat("en", { maximumSignificantDigits: 4 });

export interface Actions {
  toggle(layer: Layer): void;
  sides(sides: "first" | "second" | "both"): void;
  /** Flies to a pair of a frame. */
  fly(frame: number, bodies: number[]): void;
}

export function element<T extends HTMLElement = HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no #${id}`);
  return found as T;
}

function create(tag: string, text = "", attributes: Record<string, string> = {}): HTMLElement {
  const made = document.createElement(tag);
  made.textContent = text;
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  return made;
}

export class Panel {
  private readonly layers = new Map<Layer, HTMLElement>();
  private readonly sideButtons = new Map<string, HTMLElement>();
  private readonly legend = new Map<State, HTMLElement>();

  constructor(
    private readonly run: Run,
    private readonly actions: Actions,
  ) {
    const { header } = run;
    element("scene").textContent = header.scene;
    const fixed = header.bodies - header.moving;
    const atRest = fixed > 0 && header.frames > 1 ? [`${grouped.format(fixed)} of them at rest`] : [];
    const size = [counted(header.bodies, "bodies", "body"), ...atRest, counted(header.frames, "frames", "frame")].join(", ");
    element("source").textContent = [size, header.seed && `seed ${header.seed}`, header.source].filter(Boolean).join("; ");
    document.title = `${header.scene} – sdop view`;
    element("last").textContent = String(run.numbers[run.frames - 1]);
    for (const message of header.messages) element("notes").append(create("p", message));
    this.buildNumbers();
    this.buildSwitches();
    this.buildEffects();
    this.buildMissed();
    this.buildLegend();
  }

  private buildNumbers(): void {
    const head = create("tr");
    head.append(create("td"));
    this.run.header.runs.forEach((run, side) => {
      head.append(create("th", run.name, { scope: "col", title: run.detail }));
      for (const cell of CELLS) {
        element(`row-${cell}`).append(create("td", "–", { id: side === 0 ? cell : `${cell}-${side + 1}` }));
      }
    });
    element("numbers-head").append(head);
    const { meet } = this.run.header;
    const row = element("row-true");
    row.querySelector("th")!.title = `Pairs whose ${meet} meet, in exact arithmetic`;
    if (meet !== "meshes") row.querySelector("small")!.textContent = `pairs of ${meet} meet`;
  }

  private buildSwitches(): void {
    const toggle = (layer: Layer, key: number): void => {
      const title = layer === "cells" ? "Cells of the widest ball's diameter that hold a body's origin" : LAYER_NAMES[layer];
      const button = create("button", LAYER_NAMES[layer], { type: "button", "aria-pressed": "false", title: `${title} (${key})` });
      button.addEventListener("click", () => this.actions.toggle(layer));
      element("switches").append(button);
      this.layers.set(layer, button);
    };
    LAYERS.forEach((layer, at) => toggle(layer, at + 1));
    const { runs } = this.run.header;
    if (runs.length < 2) return;
    const choices = [
      ["first", runs[0].name],
      ["second", runs[1].name],
      ["both", "side by side"],
    ] as const;
    for (const [sides, name] of choices) {
      const button = create("button", name, { type: "button", "aria-pressed": "false", title: `${name} (v switches)` });
      button.addEventListener("click", () => this.actions.sides(sides));
      element("sides-choice").append(button);
      this.sideButtons.set(sides, button);
    }
    element("sides-choice").hidden = false;
  }

  private buildEffects(): void {
    const { effects } = this.run.header;
    const list = element("effects");
    if (!effects) {
      list.append(create("li", "not recorded", { class: "off" }));
      return;
    }
    for (const { name, on } of effects) {
      list.append(create("li", on ? `${name}: on` : `${name}: not simulated`, { class: on ? "on" : "off" }));
    }
  }

  private buildMissed(): void {
    const { runs } = this.run.header;
    let total = 0;
    runs.forEach((run, side) => {
      const { list, count } = this.run.missed(side, MAX_ROWS);
      total += count;
      for (const { frame, pair } of list) {
        const where = runs.length > 1 ? `frame ${this.run.numbers[frame]}, ${run.name}` : `frame ${this.run.numbers[frame]}`;
        element("missed").append(this.row(frame, pair, State.Missed, where));
      }
      if (count > list.length) element("missed").append(create("li", `… and ${grouped.format(count - list.length)} more of ${run.name}`));
    });
    element("missed-count").textContent = grouped.format(total);
    element("missed-section").hidden = total === 0;
  }

  /** Builds the legend: each colour's meaning and its number of pairs in this frame. */
  private buildLegend(): void {
    const states = [State.Idle, State.Reported];
    if (this.run.header.truth) states.push(State.Meets, State.Missed);
    this.run.header.focus?.bodies.forEach((body, n) => {
      const entry = create("li", `body ${body}`);
      entry.prepend(create("i", "", { style: `background: var(--pair-${n})` }));
      element("legend").append(entry);
    });
    for (const state of states) {
      const entry = create("li");
      entry.append(create("i", "", { style: `background: ${STATE_COLOURS[state]}` }));
      if (state === State.Idle && this.run.fixed.includes(1)) {
        entry.append(create("i", "", { style: "background: var(--fixed)" }), "no pair (darker: static)");
      } else {
        const count = create("b");
        entry.append(count, this.describe(state));
        this.legend.set(state, count);
      }
      element("legend").append(entry);
    }
  }

  private showLegend(frame: number, sides: number[]): void {
    const counts = sides.map((side) => this.run.counts(frame, side));
    const [one] = counts;
    const alone = sides.length === 1;
    const put = (state: State, count: number) => {
      const place = this.legend.get(state);
      if (place) place.textContent = alone ? `${counted(count, "pairs", "pair")} ` : "";
    };
    put(State.Reported, one.apart);
    put(State.Meets, one.true === null ? 0 : one.true - one.missed);
    put(State.Missed, one.missed);
    const { runs, truth } = this.run.header;
    const titles = counts.map((count, at) => {
      const known = truth ? `${grouped.format(count.apart)} of them apart, ${grouped.format(count.missed)} missed` : "";
      const text = [`${grouped.format(count.reported)} reported`, known].filter(Boolean).join(", ");
      const title = create("span", runs[sides[at]].name);
      title.append(create("small", ` ${text}`));
      return title;
    });
    element("sides").replaceChildren(...(runs.length > 1 ? titles : []));
  }

  private row(frame: number, { i, j }: Pair, state: State, note: string): HTMLElement {
    const item = create("li");
    const button = create("button", "", { type: "button", title: "Fly to this pair" });
    button.append(create("i", "", { style: `background: ${STATE_COLOURS[state]}` }), `${i} – ${j}`, create("em", note));
    button.addEventListener("click", () => this.actions.fly(frame, [i, j]));
    item.append(button);
    return item;
  }

  /** Shows the numbers of a frame. Fast enough for every frame. */
  showNumbers(frame: number, sides: number[]): void {
    element("frame").textContent = String(this.run.numbers[frame]);
    this.run.header.runs.forEach((_, side) => {
      const counts = this.run.counts(frame, side);
      const suffix = side === 0 ? "" : `-${side + 1}`;
      const total = counts.terms && 1e6 * counts.terms.reduce((a, b) => a + b, 0);
      const values: Record<(typeof CELLS)[number], string> = {
        nu: optional(counts.nu),
        nv: optional(counts.nv),
        hits: optional(counts.hits),
        reported: grouped.format(counts.reported),
        true: optional(counts.true),
        t: total === null ? "–" : short.format(total),
      };
      for (const cell of CELLS) element(cell + suffix).textContent = values[cell];
    });
    element("caption").textContent = this.caption(frame, sides[0]);
    this.showLegend(frame, sides);
  }

  private caption(frame: number, side: number): string {
    const { scene, runs } = this.run.header;
    const { reported, true: meeting, missed } = this.run.counts(frame, side);
    const parts = [`${scene}, frame ${this.run.numbers[frame]}`];
    if (runs.length === 1) parts.push(`${runs[0].name} reports ${grouped.format(reported)} pairs`);
    if (meeting !== null) parts.push(`${grouped.format(meeting)} truly meet`);
    if (missed > 0) parts.push(`${missed} missed`);
    return parts.join(" · ");
  }

  private showTerms({ terms }: Counts, side: number): void {
    const { construct, volumes } = this.run.header.runs[side];
    const place = element("terms");
    if (!terms || construct === null) {
      place.textContent = volumes ? "T is unknown: the run has no prices" : "Nu, Nv, hits and T are unknown: the record has no counters";
      return;
    }
    const bar = create("div", "", { class: "bar", "aria-hidden": "true" });
    const list = create("ul");
    terms.forEach((seconds, at) => {
      const { name, colour } = TERMS[at];
      bar.append(create("i", "", { style: `background: var(${colour}); flex-grow: ${1e6 * seconds}` }));
      const entry = create("li");
      entry.append(create("i", "", { style: `background: var(${colour})` }), `${name} `, create("b", short.format(1e6 * seconds)), " µs");
      list.append(entry);
    });
    const once = create("li", "and once, Co ");
    once.append(create("b", short.format(1e3 * construct)), " ms");
    list.append(once);
    place.replaceChildren(bar, list);
  }

  private showVolumes(frame: number, side: number): void {
    const volumes = this.run.volumes(frame, side);
    const rows: HTMLElement[] = [];
    if (volumes && volumes.length > 1) {
      const head = create("tr");
      for (const name of ["volume", "updates", "tests", "hits"]) head.append(create("th", name, { scope: "col" }));
      rows.push(head);
      for (const { name, updates, tests, hits } of volumes) {
        const row = create("tr");
        row.append(create("th", name, { scope: "row" }));
        for (const value of [updates, tests, hits]) row.append(create("td", grouped.format(value)));
        rows.push(row);
      }
    }
    element("volumes").replaceChildren(...rows);
  }

  /** Shows terms, volumes and pairs of a frame. Too slow to do for every frame while playing. */
  showLists(frame: number, side: number, picked: number | null): void {
    this.showTerms(this.run.counts(frame, side), side);
    this.showVolumes(frame, side);
    const shown: [State, Pair][] = [];
    for (const pair of this.run.pairsAt(frame)) {
      const state = this.run.state(pair.flags, side);
      if (state === State.Idle || (picked !== null && pair.i !== picked && pair.j !== picked)) continue;
      shown.push([state, pair]);
    }
    shown.sort(([a], [b]) => b - a);
    const rows = shown.slice(0, MAX_ROWS).map(([state, pair]) => this.row(frame, pair, state, this.describe(state)));
    if (shown.length > MAX_ROWS) rows.push(create("li", `… and ${grouped.format(shown.length - MAX_ROWS)} more: pick a body to list only its pairs`));
    if (shown.length === 0) rows.push(create("li", "none"));
    element("pairs").replaceChildren(...rows);
    element("pairs-count").textContent = grouped.format(shown.length);
  }

  private describe(state: State): string {
    const { truth } = this.run.header;
    const names: Record<State, string> = {
      [State.Idle]: "no pair",
      [State.Spheres]: truth ? "spheres overlap, culled" : "spheres overlap",
      [State.Reported]: truth ? "reported, but apart" : "reported",
      [State.Meets]: "truly meet, reported",
      [State.Missed]: "truly meet, missed",
    };
    return names[state];
  }

  showPicked(picked: number | null): void {
    element("picked").hidden = picked === null;
    if (picked === null) return;
    const { header, shapeOf, fixed } = this.run;
    const shape = header.shapes[shapeOf[picked]];
    const kind = fixed[picked] ? "static" : "dynamic";
    element("picked-text").textContent = `Body ${picked}: ${shape.name}, ${kind}, ${grouped.format(shape.triangles)} triangles, or-DOP with k = ${shape.ordop.k}`;
  }

  showSwitches(switches: Record<Layer, boolean>, sides: string): void {
    for (const [layer, button] of this.layers) button.setAttribute("aria-pressed", String(switches[layer]));
    for (const [name, button] of this.sideButtons) button.setAttribute("aria-pressed", String(name === sides));
  }
}

const counted = (n: number, many: string, one: string): string => `${grouped.format(n)} ${n === 1 ? one : many}`;
const optional = (value: number | null): string => (value === null ? "–" : grouped.format(value));

// The state of the page, and what changes it.

import { format, parse } from "./address.ts";
import { buildCharts } from "./courses.ts";
import type { Charts } from "./charts.ts";
import { type Key, listen } from "./keys.ts";
import { LAYERS, type Layer, type Switches } from "./overlays.ts";
import { element, LAYER_NAMES, Panel } from "./panel.ts";
import { Player, SPEEDS } from "./player.ts";
import type { Run } from "./run.ts";
import { Stage } from "./stage.ts";
import { onSettings } from "./theme.ts";

type Sides = "first" | "second" | "both";

/** While playing, lists and address are updated at most this often. */
const LIST_INTERVAL_MS = 300;

/** The picture is drawn sharp after it has been at rest for this long. */
const SHARPEN_DELAY_MS = 160;

/** How far a key press turns, in radians, and pans, as a part of the distance. */
const TURN_PER_KEY = 0.12;
const PAN_PER_KEY = 0.06;

export class Viewer {
  private readonly player: Player;
  private readonly panel: Panel;
  private readonly charts: Charts;
  private stage: Stage | null = null;
  private readonly switches = Object.fromEntries(LAYERS.map((layer) => [layer, false])) as Switches;
  private picked: number | null = null;
  private sides: Sides = "first";
  private still = false;
  private dirty = true;
  private sharp = false;
  private changed = 0;
  private lazily = 0;
  private opened = 0;

  constructor(
    private readonly run: Run,
    explain: (title: string, text: string) => void,
  ) {
    this.player = new Player(run.frames, run.header.dt);
    this.panel = new Panel(run, {
      toggle: (layer) => this.toggle(layer),
      sides: (sides) => this.setSides(sides),
      fly: (frame, bodies) => this.fly(frame, bodies),
    });
    // A single frame has nothing to plot.
    element("charts").hidden = run.frames === 1;
    this.charts = buildCharts(run, element("charts"), (frame) => this.seek(frame));
    const changed = () => {
      this.dirty = true;
    };
    try {
      this.stage = new Stage(run, element<HTMLCanvasElement>("picture"), element("labels"), changed, () => this.keepAddress());
    } catch {
      explain("No picture: this browser has no WebGL.", "The numbers, charts and lists still work.");
    }
    for (const layer of LAYERS) this.switches[layer] = run.header.layers.includes(layer);
    this.connect();
    this.readAddress();
    window.addEventListener("hashchange", () => this.readAddress());
    onSettings(() => {
      this.charts.redraw();
      changed();
    });
    this.frame(performance.now());
    this.opened = performance.now();
  }

  /** The interface for scripts. Tests control the page through it. */
  get handle() {
    const viewer = this;
    return {
      /** Goes to the frame with this number. */
      seek: (number: number) => viewer.seek(viewer.run.indexOf(number)),
      play: () => !viewer.player.playing && viewer.togglePlaying(),
      pause: () => viewer.player.playing && viewer.togglePlaying(),
      /** Milliseconds from the page's start to its first picture. */
      get opened() {
        return viewer.opened;
      },
      /** Pictures per second while playing. */
      get rate() {
        return viewer.player.rate;
      },
      get playing() {
        return viewer.player.playing;
      },
    };
  }

  private connect(): void {
    const scrub = element<HTMLInputElement>("scrub");
    scrub.max = String(this.run.frames - 1);
    scrub.addEventListener("input", () => this.seek(Number(scrub.value)));
    const click = (id: string, act: () => void) => element(id).addEventListener("click", act);
    click("play", () => this.togglePlaying());
    click("back", () => this.seek(this.player.at - 1));
    click("forth", () => this.seek(this.player.at + 1));
    click("home", () => this.home());
    click("help", () => element<HTMLDialogElement>("about").showModal());
    click("picked-clear", () => this.pick(null));
    click("picked-fly", () => this.picked !== null && this.fly(this.player.at, [this.picked]));
    const speed = element<HTMLSelectElement>("speed");
    speed.append(...SPEEDS.map((value) => new Option(value < 1 ? `1/${1 / value}` : `${value}×`, String(value))));
    speed.addEventListener("change", () => this.setSpeed(Number(speed.value)));
    this.listenForPicks();
    listen(this.keys(), element("keys"));
  }

  /** A press and release at about the same place picks; a drag turns the camera. */
  private listenForPicks(): void {
    const picture = element("picture");
    let down: [number, number] | null = null;
    picture.addEventListener("pointerdown", (event) => {
      down = event.isPrimary && event.button === 0 ? [event.offsetX, event.offsetY] : null;
    });
    picture.addEventListener("pointerup", (event) => {
      if (down && Math.hypot(event.offsetX - down[0], event.offsetY - down[1]) < 6) {
        this.pick(this.stage?.pick(event.offsetX, event.offsetY, this.shownSides().length) ?? null);
      }
      down = null;
    });
  }

  private keys(): Key[] {
    const step = (by: number) => () => this.seek(this.player.at + by);
    const turn = (right: number, up: number) => (event: KeyboardEvent) => {
      if (event.shiftKey) this.stage?.camera.pan(PAN_PER_KEY * right, PAN_PER_KEY * up);
      else this.stage?.camera.orbit(TURN_PER_KEY * right, TURN_PER_KEY * up);
      this.keepAddress();
    };
    const zoom = (factor: number) => () => {
      this.stage?.camera.zoom(factor);
      this.keepAddress();
    };
    const layers = LAYERS.map((layer, at): Key => {
      return { keys: [String(at + 1)], label: String(at + 1), does: `${LAYER_NAMES[layer]} on or off`, act: () => this.toggle(layer) };
    });
    return [
      { keys: [" ", "k"], label: "space", does: "play or pause", act: () => this.togglePlaying() },
      { keys: [",", "PageUp"], label: ",", does: "one frame back", act: step(-1) },
      { keys: [".", "PageDown"], label: ".", does: "one frame forward", act: step(1) },
      { keys: ["<"], label: "<", does: "ten frames back", act: step(-10) },
      { keys: [">"], label: ">", does: "ten frames forward", act: step(10) },
      { keys: ["Home"], label: "Home", does: "first frame", act: () => this.seek(0) },
      { keys: ["End"], label: "End", does: "last frame", act: () => this.seek(this.run.frames - 1) },
      { keys: ["["], label: "[", does: "slower", act: () => this.changeSpeed(-1) },
      { keys: ["]"], label: "]", does: "faster", act: () => this.changeSpeed(1) },
      { keys: ["ArrowLeft"], label: "←", does: "turn left; with shift, move left", act: turn(-1, 0) },
      { keys: ["ArrowRight"], label: "→", does: "turn right; with shift, move right", act: turn(1, 0) },
      { keys: ["ArrowUp"], label: "↑", does: "turn up; with shift, move up", act: turn(0, 1) },
      { keys: ["ArrowDown"], label: "↓", does: "turn down; with shift, move down", act: turn(0, -1) },
      { keys: ["+", "="], label: "+", does: "zoom in", act: zoom(0.88) },
      { keys: ["-"], label: "-", does: "zoom out", act: zoom(1 / 0.88) },
      { keys: ["r"], label: "r", does: "show everything", act: () => this.home() },
      ...layers,
      { keys: ["v"], label: "v", does: "show one strategy, the other, or both", act: () => this.nextSides() },
      { keys: ["n"], label: "n", does: "pick the next body", act: () => this.pickNext(1) },
      { keys: ["p"], label: "p", does: "pick the previous body", act: () => this.pickNext(-1) },
      { keys: ["f"], label: "f", does: "fly to the picked body", act: () => this.picked !== null && this.fly(this.player.at, [this.picked]) },
      { keys: ["m"], label: "m", does: "fly to the next missed pair", act: () => this.nextMissed() },
      { keys: ["Escape"], label: "esc", does: "clear the picked body", act: () => this.pick(null) },
      { keys: ["?"], label: "?", does: "show these keys", act: () => element<HTMLDialogElement>("about").showModal() },
    ];
  }

  private shownSides(): number[] {
    return { first: [0], second: [1], both: [0, 1] }[this.sides];
  }

  private seek(frame: number): void {
    this.player.seek(frame);
    this.refresh();
  }

  private togglePlaying(): void {
    this.player.toggle();
    this.refresh();
  }

  private toggle(layer: Layer): void {
    this.switches[layer] = !this.switches[layer];
    this.refresh();
  }

  private setSides(sides: Sides): void {
    this.sides = this.run.header.runs.length > 1 ? sides : "first";
    this.refresh();
  }

  private nextSides(): void {
    const order: Sides[] = ["first", "second", "both"];
    this.setSides(order[(order.indexOf(this.sides) + 1) % order.length]);
  }

  private setSpeed(speed: number): void {
    this.player.speed = speed;
    this.refresh();
  }

  private changeSpeed(by: 1 | -1): void {
    this.player.change(by);
    this.refresh();
  }

  private pick(body: number | null): void {
    this.picked = body;
    this.refresh();
  }

  private pickNext(by: 1 | -1): void {
    const { bodies } = this.run.header;
    this.pick(this.picked === null ? (by > 0 ? 0 : bodies - 1) : (this.picked + by + bodies) % bodies);
  }

  private home(): void {
    this.stage?.camera.home();
    this.keepAddress();
  }

  private fly(frame: number, bodies: number[]): void {
    this.player.seek(frame);
    this.stage?.flyTo(frame, bodies);
    this.refresh();
  }

  private nextMissed(): void {
    const { list } = this.run.missed(this.shownSides()[0], Number.POSITIVE_INFINITY);
    const next = list.find(({ frame }) => frame > this.player.at) ?? list[0];
    if (next) this.fly(next.frame, [next.pair.i, next.pair.j]);
  }

  /** Updates all parts of the page to the present state. */
  private refresh(): void {
    const { player } = this;
    document.body.classList.toggle("playing", player.playing);
    element("play").setAttribute("aria-label", player.playing ? "Pause" : "Play");
    element<HTMLSelectElement>("speed").value = String(player.speed);
    this.panel.showSwitches(this.switches, this.sides);
    this.panel.showPicked(this.picked);
    this.showFrame();
    this.showLists();
    this.keepAddress();
  }

  private showFrame(): void {
    const frame = this.player.at;
    element<HTMLInputElement>("scrub").value = String(frame);
    this.panel.showNumbers(frame, this.shownSides());
    this.charts.show(frame);
    this.dirty = true;
  }

  private showLists(): void {
    this.panel.showLists(this.player.at, this.shownSides()[0], this.picked);
  }

  /** Called for every picture that the browser is about to show. */
  private readonly frame = (now: number): void => {
    const before = this.player.playing;
    if (this.player.advance(now)) this.showFrame();
    if (before && !this.player.playing) this.refresh();
    if (this.player.playing && now - this.lazily > LIST_INTERVAL_MS) {
      this.lazily = now;
      this.showLists();
      this.keepAddress();
    }
    this.draw(now);
    requestAnimationFrame(this.frame);
  };

  /** Draws what has changed: fast at first, sharp as soon as nothing has moved for a moment. */
  private draw(now: number): void {
    if (!this.stage) return;
    if (this.stage.restless(now)) this.dirty = true;
    if (this.dirty) this.changed = now;
    const { at, playing } = this.player;
    const moving = !this.still && (playing || now - this.changed < SHARPEN_DELAY_MS);
    if (!this.dirty && (moving || this.sharp)) return;
    this.dirty = false;
    this.sharp = !moving;
    const { switches, picked } = this;
    this.stage.draw({ frame: at, sides: this.shownSides(), switches, picked, moving, still: this.still }, now);
  }

  private keepAddress(): void {
    const origin = this.stage?.space.origin ?? null;
    const text = format({
      frame: this.run.numbers[this.player.at],
      origin,
      camera: this.stage?.camera.state ?? null,
      switches: this.switches,
      picked: this.picked,
      sides: this.run.header.runs.length > 1 ? this.sides : null,
      speed: this.player.speed,
      still: this.still,
    });
    if (text !== location.hash) history.replaceState(null, "", text);
  }

  private readAddress(): void {
    const address = parse(location.hash);
    const { focus } = this.run.header;
    if (address.frame !== null) this.player.seek(this.run.indexOf(address.frame));
    else if (focus) this.player.seek(focus.frame);
    if (address.origin && this.stage) this.stage.space.origin = address.origin as [number, number, number];
    if (address.camera && this.stage) this.stage.camera.state = address.camera;
    else this.stage?.look(this.player.at);
    if (address.switches) Object.assign(this.switches, address.switches);
    this.picked = address.picked !== null && address.picked < this.run.header.bodies ? address.picked : null;
    if (this.run.header.runs.length > 1 && address.sides) this.sides = address.sides;
    if (address.speed !== null) this.player.speed = address.speed;
    this.still = address.still;
    document.body.classList.toggle("still", address.still);
    this.refresh();
  }
}

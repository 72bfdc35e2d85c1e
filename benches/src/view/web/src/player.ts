// Playback: which frame is due, at which speed.

/** Speeds, as multiples of real time. */
export const SPEEDS = [0.125, 0.25, 0.5, 1, 2, 4, 8];

/** Frames per second at speed 1, if the record has no duration of a frame. */
const DEFAULT_RATE = 60;

export class Player {
  playing = false;
  speed = 1;
  private frame = 0;
  private last: number | null = null;
  private rest = 0;
  private shown: number[] = [];

  constructor(
    private readonly frames: number,
    private readonly dt: number | null,
  ) {}

  get at(): number {
    return this.frame;
  }

  /** Goes to a frame, or to the nearest end. */
  seek(frame: number): void {
    this.frame = Math.max(0, Math.min(this.frames - 1, Math.round(frame)));
    this.rest = 0;
  }

  /** Plays, from the start if the end is reached, or pauses. */
  toggle(): void {
    this.playing = !this.playing;
    this.last = null;
    this.shown = [];
    if (this.playing && this.frame === this.frames - 1) this.seek(0);
  }

  /** Advances to the frame that is due; returns whether it is another one. */
  advance(now: number): boolean {
    if (!this.playing) return false;
    const passed = this.last === null ? 0 : now - this.last;
    this.last = now;
    this.shown.push(now);
    while (now - this.shown[0] > 2000) this.shown.shift();
    const rate = this.dt && this.dt > 0 ? 1 / this.dt : DEFAULT_RATE;
    this.rest += (passed / 1000) * rate * this.speed;
    // A page that was hidden for long doesn't skip frames.
    const steps = Math.min(Math.floor(this.rest), Math.ceil(rate * this.speed));
    this.rest -= Math.floor(this.rest);
    const before = this.frame;
    this.frame = Math.min(this.frames - 1, this.frame + steps);
    if (this.frame === this.frames - 1) this.playing = false;
    return this.frame !== before;
  }

  /** Pictures per second over the last two seconds of playing. */
  get rate(): number {
    const { shown } = this;
    return shown.length < 2 ? 0 : (1000 * (shown.length - 1)) / (shown[shown.length - 1] - shown[0]);
  }

  /** The next speed up or down. */
  change(by: 1 | -1): void {
    const nearest = SPEEDS.reduce((a, b) => (Math.abs(b - this.speed) < Math.abs(a - this.speed) ? b : a));
    const at = SPEEDS.indexOf(nearest) + by;
    this.speed = SPEEDS[Math.max(0, Math.min(SPEEDS.length - 1, at))];
  }
}

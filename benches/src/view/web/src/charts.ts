// Charts of numbers over the frames. A chart is drawn once per size and theme; a line over it marks
// the present frame.

export interface Course {
  name: string;
  /** A CSS colour variable. */
  colour: string;
  /** One number per frame. */
  values: Float64Array;
  dashed?: boolean;
}

export interface Chart {
  title: string;
  unit: string;
  courses: Course[];
  /** Courses lie on one another as areas. */
  stacked?: boolean;
}

const number = new Intl.NumberFormat("en", { maximumSignificantDigits: 4 });

export class Charts {
  private readonly cursors: HTMLElement[] = [];
  private readonly draws: (() => void)[] = [];

  constructor(
    private readonly element: HTMLElement,
    private readonly frames: number,
    private readonly seek: (frame: number) => void,
    /** Whose courses are dashed. */
    private readonly second: string | null,
  ) {}

  add(chart: Chart): void {
    if (chart.courses.length === 1 && chart.courses[0].values.every((x) => x === chart.courses[0].values[0])) {
      this.addConstant(chart);
      return;
    }
    const figure = document.createElement("figure");
    figure.className = "chart";
    const caption = document.createElement("figcaption");
    caption.append(`${chart.title}:`);
    for (const course of chart.courses.filter(({ dashed }) => !dashed)) {
      const entry = document.createElement("span");
      const mark = document.createElement("i");
      mark.style.background = `var(${course.colour})`;
      entry.append(mark, course.name);
      caption.append(entry);
    }
    const dashed = chart.courses.some((course) => course.dashed) && this.second;
    if (dashed) caption.append(`(dashed: ${dashed})`);
    const field = document.createElement("div");
    const canvas = document.createElement("canvas");
    const cursor = document.createElement("b");
    const top = document.createElement("span");
    top.className = "top";
    const sums = chart.stacked ? stack(chart.courses) : chart.courses;
    const most = Math.max(0, ...sums.map((course) => maximum(course.values)));
    top.textContent = `${number.format(most)}${chart.unit}`;
    canvas.setAttribute("role", "img");
    const whose = ({ name, dashed }: Course) => (dashed ? `${name} of ${this.second}` : name);
    const ranges = chart.courses.map((c) => `${whose(c)} at most ${number.format(maximum(c.values))}${chart.unit}`);
    canvas.setAttribute("aria-label", `${chart.title} over the frames: ${ranges.join(", ")}`);
    field.append(canvas, top, cursor);
    figure.append(caption, field);
    this.element.append(figure);
    this.cursors.push(cursor);
    this.listen(field);
    const draw = () => paint(canvas, sums, most, chart.stacked === true);
    this.draws.push(draw);
    new ResizeObserver(draw).observe(canvas);
  }

  /** A number that never changes is shown as text. */
  private addConstant({ title, unit, courses: [{ name, values }] }: Chart): void {
    const text = document.createElement("p");
    text.className = "constant";
    text.textContent = `${title}: ${number.format(values[0])}${unit} ${name} in every frame`;
    this.element.append(text);
  }

  /** Moves the line to a frame. */
  show(frame: number): void {
    const part = this.frames > 1 ? frame / (this.frames - 1) : 0;
    for (const cursor of this.cursors) cursor.style.left = `calc(${(100 * part).toFixed(3)}% - ${part.toFixed(3)}px)`;
  }

  /** Draws all charts again: colours have changed. */
  redraw(): void {
    for (const draw of this.draws) draw();
  }

  private listen(field: HTMLElement): void {
    const go = (event: PointerEvent) => {
      const { left, width } = field.getBoundingClientRect();
      this.seek(Math.round(((event.clientX - left) / width) * (this.frames - 1)));
    };
    field.addEventListener("pointerdown", (event) => {
      field.setPointerCapture(event.pointerId);
      go(event);
    });
    field.addEventListener("pointermove", (event) => {
      if (field.hasPointerCapture(event.pointerId)) go(event);
    });
  }
}

function maximum(values: Float64Array): number {
  return values.reduce((most, x) => (x > most ? x : most), 0);
}

/** Each course plus all before it; the last comes first, so that it is painted under the others. */
function stack(courses: Course[]): Course[] {
  const sums: Course[] = [];
  for (const course of courses) {
    const below = sums[0]?.values;
    sums.unshift({ ...course, values: course.values.map((x, f) => x + (below ? below[f] : 0)) });
  }
  return sums;
}

function paint(canvas: HTMLCanvasElement, courses: Course[], most: number, filled: boolean): void {
  const { width, height } = canvas.getBoundingClientRect();
  const context = canvas.getContext("2d");
  if (!context || width === 0) return;
  canvas.width = Math.round(width * devicePixelRatio);
  canvas.height = Math.round(height * devicePixelRatio);
  context.scale(devicePixelRatio, devicePixelRatio);
  const style = getComputedStyle(canvas);
  const y = (value: number) => height - 2 - (most > 0 ? (value / most) * (height - 4) : 0);
  for (const course of courses) {
    context.beginPath();
    context.strokeStyle = context.fillStyle = style.getPropertyValue(course.colour);
    context.lineWidth = 1.4;
    context.setLineDash(course.dashed ? [4, 3] : []);
    const columns = reduce(course.values, Math.ceil(width));
    columns.forEach(([low, high], x) => {
      const at = columns.length > 1 ? (x / (columns.length - 1)) * (width - 1) + 0.5 : width / 2;
      context.lineTo(at, y(low));
      if (high > low) context.lineTo(at, y(high));
    });
    if (filled) {
      context.lineTo(width, height);
      context.lineTo(0, height);
      context.fill();
    } else {
      context.stroke();
    }
  }
}

/** The least and the greatest value in each of at most `columns` runs of frames. */
export function reduce(values: Float64Array, columns: number): [number, number][] {
  const count = Math.min(columns, values.length);
  return Array.from({ length: count }, (_, column) => {
    const start = Math.floor((column * values.length) / count);
    const end = Math.max(start + 1, Math.floor(((column + 1) * values.length) / count));
    let [low, high] = [Infinity, -Infinity];
    for (let f = start; f < end; f++) {
      low = Math.min(low, values[f]);
      high = Math.max(high, values[f]);
    }
    return [low, high];
  });
}

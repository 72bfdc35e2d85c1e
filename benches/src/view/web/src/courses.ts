// Which numbers the charts show.

import { type Chart, Charts } from "./charts.ts";
import { TERMS } from "./panel.ts";
import type { Counts, Run } from "./run.ts";

/** Builds the charts of a run. A second strategy's courses are dashed. */
export function buildCharts(run: Run, element: HTMLElement, seek: (frame: number) => void): Charts {
  const charts = new Charts(element, run.frames, seek, run.header.runs[1]?.name ?? null);
  const counts = run.header.runs.map((_, side) => Array.from({ length: run.frames }, (_, frame) => run.counts(frame, side)));
  const chart = (title: string, unit: string, courses: [string, string, (c: Counts) => number | null][]): void => {
    const made: Chart = { title, unit, courses: [] };
    counts.forEach((list, side) => {
      for (const [name, colour, get] of courses) {
        if (list.some((c) => get(c) === null)) continue;
        // Both strategies have the same truth.
        if (side > 0 && name === "true") continue;
        made.courses.push({ name, colour, values: Float64Array.from(list, (c) => get(c)!), dashed: side > 0 });
      }
    });
    if (made.courses.length > 0) charts.add(made);
  };
  chart("Pairs", "", [
    ["hits", "--spheres", (c) => c.hits],
    ["reported", "--reported", (c) => c.reported],
    ["true", "--meets", (c) => c.true],
  ]);
  chart("Missed", "", counts.flat().some((c) => c.missed > 0) ? [["missed", "--missed", (c) => c.missed]] : []);
  chart("Nu", "", [["updates", "--update", (c) => c.nu]]);
  chart("Nv", "", [["tests", "--test", (c) => c.nv]]);
  counts.forEach((list, side) => {
    if (list.some((c) => c.terms === null)) return;
    const title = counts.length > 1 ? `T, ${run.header.runs[side].name}` : "T";
    charts.add({
      title,
      unit: " µs",
      stacked: true,
      courses: TERMS.map((term, at) => ({ ...term, values: Float64Array.from(list, (c) => 1e6 * c.terms![at]) })),
    });
  });
  return charts;
}

// The page to play with: a form of settings, and a program that culls the scene in the browser.
// Each choice loads the page again, so that its address names what it shows.

import { fromBase64 } from "./data.ts";
import type {} from "./main.ts";
import { OWN, readSettings, sceneFile, type Settings, SETTINGS } from "./scene.ts";
import { run } from "./wasi.ts";

const STRATEGIES = ["s-dop-sequential", "s-dop-batch", "s-dop-object-of-interest", "sphere", "or-dop", "aabb", "k-dop", "obb"];
const CHOICES: [keyof Settings, string, string[]][] = [
  ["bodies", "bodies", ["50", "100", "150", "200", "300", "400", "500"]],
  ["meshes", "meshes", ["paper", "balls"]],
  ["strategy", "culled by", STRATEGIES],
  ["beside", "next to", ["nothing", ...STRATEGIES]],
  ["k", "faces k of or-DOPs", ["6", "14", "18", "26"]],
  ["interest", "object of interest", []],
  ["frames", "frames", ["60", "240", "1000"]],
  ["seed", "seed", []],
  ["truth", "exact truth", ["no", "yes"]],
];
/** Where the browser keeps a dropped file while this tab is open. */
const STORED = "sdop-own-mesh";

// The viewer's sources, which the page has already, would come with its function of this name.
const element = (id: string) => document.getElementById(id)!;

const settings = readSettings(location.search);

function show(change: Partial<Settings>): void {
  location.assign(`${location.pathname}?${new URLSearchParams({ ...settings, ...change })}`);
}

function control(name: keyof Settings, label: string, choices: string[]): HTMLElement {
  const made = document.createElement(choices.length > 0 ? "select" : "input");
  if (made instanceof HTMLInputElement) Object.assign(made, { type: "number", min: "0", max: "4294967295", inputMode: "numeric" });
  else made.append(...[...new Set([...choices, settings[name]])].map((choice) => new Option(choice)));
  made.value = settings[name];
  made.id = `play-${name}`;
  made.addEventListener("change", () => show({ [name]: made.value || SETTINGS[name] }));
  const row = document.createElement("label");
  row.append(label, made);
  return row;
}

async function keep(file: File): Promise<void> {
  const bytes = new Uint8Array(await file.arrayBuffer());
  try {
    sessionStorage.setItem(STORED, JSON.stringify([file.name, Array.from(bytes, (byte) => String.fromCharCode(byte)).join("")]));
  } catch {
    return explain(`${file.name} is too large: the browser keeps about 5 MB.`);
  }
  show({ meshes: OWN });
}

function buildForm(): void {
  const form = document.createElement("form");
  form.id = "play-form";
  form.append(...CHOICES.map((choice) => control(...choice)));
  const file = Object.assign(document.createElement("input"), { type: "file", accept: ".obj,.stl,.ply,.off,.tri" });
  file.addEventListener("change", () => file.files?.[0] && keep(file.files[0]));
  const row = document.createElement("label");
  row.append("a mesh of yours (or drop it here)", file);
  const style = document.createElement("style");
  style.textContent = "#play-form { display: grid; gap: .3rem } #play-form label { display: grid; grid-template-columns: 1fr 11rem; align-items: center } #play-form :is(input, select) { font: inherit; width: 100%; min-height: 2.1rem }";
  form.append(row, style);
  form.addEventListener("submit", (event) => event.preventDefault());
  form.addEventListener("keydown", (event) => event.stopPropagation()); // the viewer has keys, too
  element("notes").before(form);
  document.addEventListener("dragover", (event) => event.preventDefault());
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    const [dropped] = event.dataTransfer?.files ?? [];
    if (dropped) keep(dropped);
  });
}

function explain(text: string): void {
  element("message").hidden = text === "";
  element("message").textContent = text;
}

/** The bytes of a file that the page carries: deflated, in base64. */
async function carried(script: Element): Promise<Uint8Array<ArrayBuffer>> {
  const packed = new Blob([fromBase64(script.textContent!) as BlobPart]);
  script.remove();
  return new Uint8Array(await new Response(packed.stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer());
}

async function play(): Promise<void> {
  buildForm();
  explain(`Culling ${settings.frames} frames of ${settings.bodies} bodies in this browser …`);
  await new Promise((painted) => requestAnimationFrame(() => setTimeout(painted)));
  const files = new Map<string, Uint8Array<ArrayBuffer>>();
  for (const script of document.querySelectorAll("script[data-file]")) files.set(script.getAttribute("data-file")!, await carried(script));
  const [own, text] = JSON.parse(sessionStorage.getItem(STORED) ?? "[\"\", \"\"]") as [string, string];
  if (own) files.set(own, Uint8Array.from(text, (char) => char.charCodeAt(0)));
  files.set("scene.toml", new TextEncoder().encode(sceneFile(settings, own)));
  const args = ["sdop-live", "/scene.toml"];
  if (settings.truth === "yes") args.push("--truth");
  if (settings.beside !== "nothing") args.push(settings.beside);
  const module = await WebAssembly.compile(files.get("sdop-live.wasm")!);
  document.body.insertAdjacentHTML("beforeend", await run(module, args, files));
  explain("");
  const begins = location.hash === "";
  const viewer = document.createElement("script");
  viewer.textContent = new TextDecoder().decode(files.get("viewer.js"));
  document.body.append(viewer);
  if (begins) window.sdop?.play();
}

play().catch((error: Error) => explain(`This can't be shown.\n\n${error.message}`));

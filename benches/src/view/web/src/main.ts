// The page: reads its data, wires picture, panel and playback together, and keeps the address.

import { DataError, readDocument } from "./data.ts";
import { element } from "./panel.ts";
import { Run } from "./run.ts";
import { Viewer } from "./viewer.ts";

declare global {
  interface Window {
    /** For tests, and for use in the browser's console. */
    sdop?: Viewer["handle"];
  }
}

function explain(title: string, text: string): void {
  const message = element("message");
  message.hidden = false;
  message.textContent = `${title}\n\n${text}`;
}

function start(): void {
  let run: Run;
  try {
    const { header, blocks } = readDocument(document);
    // Such a page also has no blocks.
    if (header.frames === 0) throw new DataError(header.messages.join("\n") || "the run has no frames");
    run = new Run(header, blocks);
  } catch (error) {
    if (!(error instanceof DataError)) throw error;
    document.body.classList.add("broken");
    explain("This run can't be shown.", error.message);
    return;
  }
  const viewer = new Viewer(run, explain);
  window.sdop = viewer.handle;
}

start();

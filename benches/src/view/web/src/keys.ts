// The keyboard: one table for what keys do and for the help that lists them.

export interface Key {
  /** Values of `KeyboardEvent.key`. */
  keys: string[];
  /** How the help writes them. */
  label: string;
  does: string;
  act: (event: KeyboardEvent) => void;
}

/** Elements that handle keys themselves: they keep space and letters. */
const OWN_KEYS = new Set(["INPUT", "SELECT", "TEXTAREA"]);

/** Handles the keys wherever the focus is, unless the focused element needs them. */
export function listen(keys: Key[], table: HTMLElement): void {
  for (const { label, does } of keys) {
    const row = document.createElement("tr");
    const cell = document.createElement("td");
    for (const name of label.split(" ")) {
      const key = document.createElement("kbd");
      key.textContent = name;
      cell.append(key, " ");
    }
    const text = document.createElement("td");
    text.textContent = does;
    row.append(cell, text);
    table.append(row);
  }
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
    const target = event.target as HTMLElement;
    const pressed = event.key;
    if (document.querySelector("dialog[open]") && pressed !== "?") return;
    const busy = OWN_KEYS.has(target.tagName) || (target.tagName === "BUTTON" && (pressed === " " || pressed === "Enter"));
    // A slider and a list move by arrows and letters; our other keys still work there.
    if (busy && (pressed === " " || pressed === "Enter" || pressed.startsWith("Arrow") || pressed === "Home" || pressed === "End")) return;
    if (target.tagName === "SELECT" && pressed.length === 1) return;
    const key = keys.find((candidate) => candidate.keys.includes(pressed));
    if (!key) return;
    event.preventDefault();
    key.act(event);
  });
}

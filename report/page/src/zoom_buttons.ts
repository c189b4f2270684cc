// The buttons that zoom a view of the map.
import { el } from "./elements";

interface Zoomable {
  zoom(factor: number): void;
  fit(): void;
}

export function iconButton(label: string, text: string, work: () => void): HTMLElement {
  return el("button", { type: "button", title: label, "aria-label": label, click: work }, text);
}

/** `more` stands behind them. */
export function zoomButtons(view: Zoomable, ...more: HTMLElement[]): HTMLElement {
  return el(
    "div",
    { class: "zoom" },
    iconButton("Zoom in (+)", "+", () => view.zoom(1.5)),
    iconButton("Zoom out (-)", "−", () => view.zoom(1 / 1.5)),
    iconButton("Show everything (0)", "⤢", () => view.fit()),
    ...more,
  );
}

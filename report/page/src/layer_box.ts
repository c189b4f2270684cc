// The entries of a map's legend that switch layers.
import { el } from "./elements";
import { meaningOf } from "./words";

/** A box with the layer's symbol and name, which tells what the layer is; `attribute` has the layer's key. */
export function layerBox(layer: string, name: string, attribute: string, switched: (isShown: boolean) => void): { label: HTMLElement; box: HTMLInputElement } {
  const box = el("input", { type: "checkbox", checked: true, [attribute]: layer, change: () => switched(box.checked) });
  const label = el("label", {}, box, el("span", { class: `symbol ${layer}`, "aria-hidden": "true" }), name);
  // Without a mark of its own: the box has the focus.
  const meaning = meaningOf(name) ?? meaningOf(layer);
  if (meaning !== undefined) label.dataset.meaning = meaning;
  return { label, box };
}

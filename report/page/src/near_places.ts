// Lists the clusters near a place that was clicked: on the map they may hide each other.
import { ratingColour } from "./colours";
import type { Steps } from "./data";
import { el, replace } from "./elements";
import { fixed, significant } from "./numbers";
import type { Store } from "./store";

const mostListed = 8;

export class NearPlaces {
  readonly element = el("div", { class: "near", role: "region", "aria-label": "Clusters near the place clicked", hidden: true });

  constructor(private readonly store: Store) {
    store.subscribe((change) => change.step && this.hide());
    this.element.addEventListener("keydown", (event) => {
      if (event.key !== "Escape") return;
      this.hide();
      event.stopPropagation(); // It would leave the full screen, too.
    });
  }

  hide(): void {
    this.element.hidden = true;
  }

  /** What lies within `radius` m of a place of the map, the nearest first. */
  show(steps: Steps, place: { x: number; y: number }, radius: number): void {
    const { best } = steps;
    const { step } = this.store.selected;
    const found: { rank: number; distance: number }[] = [];
    for (let k = best.first[step]; k < best.first[step + 1]; ++k) {
      const distance = Math.hypot(best.x[k] - place.x, best.y[k] - place.y);
      if (distance <= radius) found.push({ rank: k - best.first[step], distance });
    }
    found.sort((a, b) => a.distance - b.distance);
    const entry = ({ rank, distance }: { rank: number; distance: number }): HTMLElement => {
      const k = best.first[step] + rank;
      return el(
        "li",
        {},
        el("button", { type: "button", click: () => this.store.chooseHypothesis(rank) }, `cluster ${rank + 1}`),
        el("i", { class: "swatch", style: `background: ${ratingColour(best.r[k])}` }),
        ` r ${significant(best.r[k])}, ${fixed(distance, 2)} m away`,
      );
    };
    const within = `within ${significant(radius, 2)} m of ${fixed(place.x, 2)}, ${fixed(place.y, 2)}`;
    const rest = found.length - mostListed;
    replace(
      this.element,
      el("button", { type: "button", class: "close", "aria-label": "Close", click: () => this.hide() }, "✕"),
      el("strong", {}, found.length === 0 ? `No cluster ${within}` : `${found.length} ${found.length === 1 ? "cluster" : "clusters"} ${within}`),
      found.length > 0 && el("ul", {}, ...found.slice(0, mostListed).map(entry)),
      rest > 0 && el("p", {}, `and ${rest} more`),
    );
    this.element.hidden = false;
  }
}

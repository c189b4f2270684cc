// What the map shows, and the legend that switches it.
import { errorColour, errorRange, ratingColour, verdictColours, verdictName } from "./colours";
import type { VerdictKind } from "./data";
import { colourBar, el, replace } from "./elements";
import { layerBox } from "./layer_box";
import type { Linked } from "./view_change";
import { explained } from "./words";

const layers = {
  space: "free, unknown",
  grid: "grid",
  map: "global map",
  local_map: "local map",
  scan: "scan",
  unmapped: "new",
  beyond: "gone",
  view: "field of view",
  clusters: "clusters",
  candidates: "candidates",
  estimate: "estimate",
  reference: "reference",
  ends: "start, end",
  unknown_place: "unknown place",
} as const;
export type Layer = keyof typeof layers;

/** What the dots of the estimate tell by their colour. */
const trajectoryColours = { plain: "one colour", verdict: "verdict", error: "error" } as const;
export type TrajectoryColour = keyof typeof trajectoryColours;

export class MapLegend implements Linked {
  readonly element: HTMLElement;
  readonly shown: Record<Layer, boolean>;
  private readonly boxes = new Map<Layer, HTMLInputElement>();
  private readonly colourBy = el("select", { "aria-label": "Colour of the estimate" });
  private readonly errorScale = el("span", { class: "scale" });

  /** `changed` is told of another choice, and `followed` of whether to follow the robot. */
  constructor(
    private readonly changed: () => void,
    private readonly followed: (follows: boolean) => void,
  ) {
    this.shown = Object.fromEntries(Object.keys(layers).map((layer) => [layer, true])) as Record<Layer, boolean>;
    this.element = this.legend();
  }

  /** Of the estimate's dots. */
  get colour(): TrajectoryColour {
    return this.colourBy.value as TrajectoryColour;
  }

  state(): Record<string, string> {
    const hidden = (Object.keys(layers) as Layer[]).filter((layer) => !this.shown[layer]);
    return {
      ...(hidden.length > 0 ? { hide: hidden.join(",") } : {}),
      ...(this.colour === "plain" ? {} : { colour: this.colour }),
    };
  }

  setState(said: URLSearchParams): void {
    const hidden = (said.get("hide") ?? "").split(",");
    for (const [layer, box] of this.boxes) this.shown[layer] = box.checked = !hidden.includes(layer);
    const colour = said.get("colour") ?? "";
    this.colourBy.value = colour in trajectoryColours ? colour : "plain";
    this.showErrorScale();
  }

  private legend(): HTMLElement {
    const entry = (layer: Layer): HTMLElement => {
      const { label, box } = layerBox(layer, layers[layer], "data-layer", (isShown) => {
        this.shown[layer] = isShown;
        this.changed();
      });
      this.boxes.set(layer, box);
      return label;
    };
    const follow = el("input", { type: "checkbox", change: () => this.followed(follow.checked) });
    for (const [value, text] of Object.entries(trajectoryColours)) this.colourBy.append(el("option", { value }, text));
    this.colourBy.addEventListener("change", () => {
      this.showErrorScale();
      this.changed();
    });
    const { least, most } = errorRange;
    const errorBar = colourBar((share) => errorColour(least * (most / least) ** share));
    replace(this.errorScale, `error  ${least} m `, errorBar, ` ${most} m`);
    this.showErrorScale();
    const verdicts = (Object.keys(verdictColours) as VerdictKind[]).map((kind) =>
      el("span", {}, el("i", { class: "swatch", style: `background: ${verdictColours[kind]}` }), verdictName(kind)),
    );
    return el(
      "figcaption",
      { class: "legend" },
      ...(Object.keys(layers) as Layer[]).map(entry),
      el("span", { class: "scale" }, explained(el("span", {}, "rating r"), "r"), "  0 ", colourBar(ratingColour), " 1"),
      el("span", { class: "verdicts" }, explained(el("span", {}, "strip of verdicts"), "verdict"), ...verdicts),
      el("label", {}, "estimate by ", this.colourBy),
      el("label", {}, follow, "follow the robot"),
      this.errorScale,
    );
  }

  private showErrorScale(): void {
    this.errorScale.hidden = this.colourBy.value !== "error";
  }
}

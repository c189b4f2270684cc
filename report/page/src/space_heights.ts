// The heights of a map in space: the colours they have, and the slider that hides what is above one.
import { Color, Plane, Vector3 } from "three";
import { ratingColour } from "./colours";
import { metres } from "./data";
import { el, replace } from "./elements";
import { fixed } from "./numbers";

const ceiling = { share: 0.15, from: 0.8, cut: 70 };

/** Where nearly all values lie, m: a few stray points would make the rest small. */
export function rangeOf(values: number[]): [number, number] {
  const sorted = Int32Array.from(values).sort();
  const at = (share: number): number => sorted[Math.round(share * (sorted.length - 1))] * metres;
  const [low, high] = [at(0.005), at(0.995)];
  return high > low ? [low, high] : [low - 0.5, low + 0.5];
}

/** Whether so many points are near the top that they hide what is below. */
function hasCeiling(z: number[], [low, high]: [number, number]): boolean {
  const from = (low + ceiling.from * (high - low)) / metres;
  return z.filter((height) => height > from).length > ceiling.share * z.length;
}

export class Heights {
  /** Scale of the colours, and the slider. */
  readonly legend: HTMLElement[];
  /** In the scene, whose origin is in the middle of the heights. */
  readonly clip = new Plane(new Vector3(0, 0, -1), Infinity);
  private readonly low = el("span", {});
  private readonly high = el("span", {});
  private readonly bar = el("span", { class: "bar" });
  private readonly cut = el("input", { type: "range", min: 0, max: 100, value: 100, "aria-label": "Hide points above this height" });
  private readonly cutAt = el("output", {});
  private range: [number, number] = [0, 1];
  private openingCut = "100";

  constructor(private readonly changed: () => void) {
    this.legend = [
      el("span", { class: "scale" }, "height ", this.low, this.bar, this.high),
      el("label", { class: "cut" }, "show ", this.cut, this.cutAt),
    ];
    this.cut.addEventListener("input", () => this.cutPoints());
  }

  /** Those of another map, whole mm, and where nearly all of them lie. */
  take(z: number[], range: [number, number]): void {
    this.range = range;
    replace(this.low, `${fixed(range[0], 1)} m `);
    replace(this.high, ` ${fixed(range[1], 1)} m`);
    this.openingCut = String(hasCeiling(z, range) ? ceiling.cut : 100);
    this.setState(null);
  }

  /** Red, green and blue of each height, by the page's theme. */
  colours(z: number[]): Float32Array {
    const scale = this.scale();
    const [low, high] = this.range;
    const colours = new Float32Array(3 * z.length);
    z.forEach((height, i) => {
      const share = Math.min(Math.max((height * metres - low) / (high - low), 0), 1);
      scale[Math.round(255 * share)].toArray(colours, 3 * i);
    });
    return colours;
  }

  /** What a link says: percent of the heights that are shown; null where that is as at first. */
  state(): string | null {
    return this.cut.value === this.openingCut ? null : this.cut.value;
  }

  setState(said: string | null): void {
    this.cut.value = said !== null && /^\d+$/.test(said) ? said : this.openingCut;
    this.cutPoints();
  }

  /** From low to high; of viridis what is seen on this paper: its yellow fades on white, its violet on black. */
  private scale(): Color[] {
    const isDark = document.documentElement.dataset.theme === "dark";
    const [from, to] = isDark ? [0.22, 1] : [0, 0.86];
    const stops = Array.from({ length: 256 }, (_, i) => ratingColour(from + ((to - from) * i) / 255));
    this.bar.style.background = `linear-gradient(to right, ${[0, 64, 128, 192, 255].map((i) => stops[i]).join(", ")})`;
    return stops.map((stop) => new Color(stop));
  }

  private cutPoints(): void {
    const share = Number(this.cut.value) / 100;
    const [low, high] = this.range;
    const at = low + share * (high - low);
    this.clip.constant = share < 1 ? at - (low + high) / 2 : Infinity;
    replace(this.cutAt, share < 1 ? `up to ${fixed(at, 1)} m` : "all heights");
    this.changed();
  }
}

// What trials of several runs or settings needed and how well they did, as box plots side by side.
import { ofRight, stepTimes, type Group } from "./answers";
import { boxOf, type Box, type Dots } from "./boxes";
import { runColour } from "./colours";
import { el, replace } from "./elements";
import { saveMenu } from "./export";
import { count, significant } from "./numbers";
import { isLogarithmic, logTicks, svg, ticks } from "./svg";
import { svgFile } from "./svg_file";

interface Measure {
  id: string;
  title: string;
  unit: string;
  /** What there are values of. */
  of: string;
  values: (group: Group) => number[];
}

const measures: Measure[] = [
  { id: "steps", title: "Steps to localize", unit: "steps", of: "right trials", values: ofRight((t) => t.steps) },
  { id: "way", title: "Way to localize", unit: "m", of: "right trials", values: ofRight((t) => t.distance_m) },
  { id: "translation", title: "Error when localized", unit: "m", of: "right trials", values: ofRight((t) => t.translation_error_m) },
  { id: "rotation", title: "Error of the angle", unit: "°", of: "right trials", values: ofRight((t) => t.rotation_error_deg) },
  { id: "time", title: "Wall time of a step", unit: "ms", of: "steps", values: stepTimes },
];

const mostAtFirst = 18;
const mostOutliers = 120;
const row = 22; // px
const footer = 34; // px, for the axis

/** One row of a chart. */
interface Entry {
  group: Group;
  index: number;
  values: number[];
  box: Box | Dots | null;
}

/** Empty for one group, which has nothing beside it. */
export class BoxPlots {
  readonly element = el("div", { class: "boxes" });
  private readonly charts: BoxChart[];
  private readonly more: HTMLButtonElement;

  constructor(groups: Group[]) {
    const all = groups.length > 1 ? measures : [];
    const entries = (measure: Measure): Entry[] =>
      groups.map((group, index) => {
        const values = measure.values(group);
        return { group, index, values, box: boxOf(values) };
      });
    this.charts = all.map((measure) => new BoxChart(measure, entries(measure))).filter((chart) => !chart.isEmpty);
    this.more = el("button", { type: "button", click: () => this.showAll() }, `all ${count(groups.length)}`);
    this.element.hidden = this.charts.length === 0;
    replace(
      this.element,
      el("div", { class: "panels" }, ...this.charts.map((chart) => chart.element)),
      el(
        "p",
        { class: "note" },
        "Boxes reach from the first to the third quarter of the values, with a line at the median; whiskers reach the farthest values within ",
        "one and a half lengths of the box, and dots are beyond. Fewer than eight values are dots. At the right: the median. ",
        groups.length > mostAtFirst && this.more,
      ),
    );
  }

  private showAll(): void {
    this.more.remove();
    for (const chart of this.charts) chart.showAll();
  }
}

class BoxChart {
  readonly element: HTMLElement;
  private readonly target = el("div", { class: "box-plot" });
  private drawing: SVGSVGElement | null = null;
  private shown = mostAtFirst;
  private width = 0;

  constructor(
    private readonly measure: Measure,
    private readonly entries: Entry[],
  ) {
    const { id, title, unit, of } = measure;
    const told = unit === "steps" ? title : `${title}, ${unit}`;
    const menu = saveMenu(() => title, () => (this.drawing ? svgFile(this.drawing, `${told} of ${of}`) : ""));
    this.element = el("div", { class: "panel", "data-boxes": id }, el("h3", {}, told, el("small", {}, ` of ${of}`)), menu, this.target);
    new ResizeObserver(() => {
      // What is drawn makes the panel higher, not wider.
      if (this.target.clientWidth !== this.width) this.draw();
    }).observe(this.target);
  }

  get isEmpty(): boolean {
    return this.entries.every((entry) => entry.box === null);
  }

  showAll(): void {
    this.shown = this.entries.length;
    this.draw();
  }

  private draw(): void {
    this.width = this.target.clientWidth;
    if (this.width === 0) return;
    const entries = this.entries.slice(0, this.shown);
    const height = row * entries.length + footer;
    const longest = Math.max(...entries.map(({ group }) => group.name.length));
    const left = Math.min(Math.max(40, 6.4 * longest + 12), 0.36 * this.width);
    const right = this.width - 52;
    const scale = this.scale(entries, left, right);
    const bottom = height - footer + 4;
    const grid = scale.ticks.map((tick) => {
      const x = scale.at(tick);
      return svg(
        "g",
        { class: "tick" },
        svg("line", { x1: x, x2: x, y1: 2, y2: bottom }),
        svg("text", { x, y: bottom + 13, "text-anchor": "middle" }, label(tick)),
      );
    });
    const description = `${this.measure.title}: ${entries.map(told).join("; ")}`;
    this.drawing = svg(
      "svg",
      { viewBox: `0 0 ${this.width} ${height}`, width: this.width, height, role: "img", "aria-label": description },
      ...grid,
      svg("text", { class: "unit", x: (left + right) / 2, y: height - 3, "text-anchor": "middle" }, this.measure.unit + (scale.isLog ? ", logarithmic" : "")),
      ...entries.map((entry, i) => this.row(entry, i, scale.at, left)),
    );
    replace(this.target, this.drawing);
  }

  /** From values to px. */
  private scale(entries: Entry[], left: number, right: number): { at: (value: number) => number; ticks: number[]; isLog: boolean } {
    const all = entries.flatMap(({ box }) => (box ? extremes(box) : []));
    let [low, high] = [Math.min(...all), Math.max(...all)];
    const isLog = isLogarithmic(low, high);
    // Lengths and times begin at nothing, unless all are far from it.
    if (!isLog && low < 0.5 * high) low = 0;
    if (high === low) [low, high] = [low - 0.5, high + 0.5];
    const by = isLog ? Math.log10 : (v: number): number => v;
    const at = (v: number): number => left + 6 + ((right - left - 12) * (by(v) - by(low))) / (by(high) - by(low));
    return { at, ticks: isLog ? apart(logTicks(low, high), at) : ticks(low, high, (right - left) / 70), isLog };
  }

  private row(entry: Entry, i: number, at: (value: number) => number, left: number): SVGElement {
    const { group: of, index, box } = entry;
    const y = row * i + row / 2 + 2;
    const shown = Math.max(3, Math.floor((left - 10) / 6.4));
    const group = svg("g", { "data-run": index }, svg("title", {}, told(entry)));
    group.style.setProperty("--colour", runColour(index));
    group.append(svg("text", { x: left - 8, y: y + 4, "text-anchor": "end", class: "name" }, shortened(of.name, shown)));
    if (!box) {
      group.append(svg("text", { x: left + 6, y: y + 4, class: "none" }, `no ${this.measure.of}`));
      return group;
    }
    const dots = box.kind === "dots" ? box.values : few(box.outliers);
    if (box.kind === "box") {
      const [low, quarter, three, high] = [box.low, box.quarter, box.three_quarters, box.high].map(at);
      group.append(
        svg("path", { class: "whisker", d: `M${low} ${y}H${quarter}M${three} ${y}H${high}M${low} ${y - 3}v6M${high} ${y - 3}v6` }),
        svg("rect", { class: "box", x: quarter, y: y - 6, width: Math.max(three - quarter, 1), height: 12 }),
      );
    }
    group.append(
      ...dots.map((value) => svg("circle", { class: "dot", cx: at(value).toFixed(1), cy: y, r: box.kind === "dots" ? 3 : 1.8 })),
      svg("path", { class: "median", d: `M${at(box.median)} ${y - 6}v12` }),
      svg("text", { x: this.width - 4, y: y + 4, "text-anchor": "end", class: "value" }, short(box.median)),
    );
    return group;
  }
}

function told({ group, values, box }: Entry): string {
  if (!box) return `${group.name}: none`;
  const half = box.kind === "box" ? `, half of them from ${short(box.quarter)} to ${short(box.three_quarters)}` : "";
  return `${group.name}: ${count(values.length)} values, median ${short(box.median)}${half}`;
}

/** Whole numbers without digits that say nothing. */
function short(value: number): string {
  return Number.isInteger(value) ? count(value) : significant(value);
}

/** Those whose labels have room; powers of ten first. */
function apart(all: number[], at: (tick: number) => number): number[] {
  const isPower = (tick: number): boolean => Number.isInteger(Number(Math.log10(tick).toFixed(9)));
  const kept: number[] = [];
  for (const tick of [...all.filter(isPower), ...all.filter((tick) => !isPower(tick))])
    if (kept.every((other) => Math.abs(at(other) - at(tick)) >= 36)) kept.push(tick);
  return kept;
}

/** Names often differ at their ends only. */
function shortened(name: string, most: number): string {
  if (name.length <= most) return name;
  const head = Math.floor(0.4 * most);
  return `${name.slice(0, head)}…${name.slice(name.length - (most - head - 1))}`;
}

function extremes(box: Box | Dots): number[] {
  // Ascending; there may be very many.
  const far = box.kind === "dots" ? box.values : box.outliers;
  const ends = [far[0], far[far.length - 1], ...(box.kind === "box" ? [box.low, box.high] : [])];
  const known = ends.filter((end) => end !== undefined);
  return [Math.min(...known), Math.max(...known)];
}

/** Thousands of dots are a line: every so many, and both ends. */
function few(sorted: number[]): number[] {
  if (sorted.length <= mostOutliers) return sorted;
  const stride = (sorted.length - 1) / (mostOutliers - 1);
  return Array.from({ length: mostOutliers }, (_, i) => sorted[Math.round(i * stride)]);
}

function label(tick: number): string {
  return tick !== 0 && (Math.abs(tick) < 1e-3 || Math.abs(tick) >= 1e5) ? tick.toExponential(0) : String(Number(tick.toPrecision(6)));
}

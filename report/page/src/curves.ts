// The curves of the paper's Fig. 3, step by step, with one cursor that the slider shares.
import type uPlot from "uplot";
import { chart, type Line } from "./charts";
import { runColour, runLine, themeColour } from "./colours";
import { firstLocalized, type Column, type Run, type Steps, type Trial } from "./data";
import { el, replace } from "./elements";
import { count, significant } from "./numbers";
import { drawSegment } from "./pen";
import { matchingTrial, type Change, type Store } from "./store";
import { svg } from "./svg";
import { explained } from "./words";

interface Curve {
  id: string;
  title: string;
  unit?: string;
  /** What the axis says. */
  axis: string;
  values: (steps: Steps) => Column;
  /** Drawn dashed. */
  second?: { name: string; values: (steps: Steps) => Column };
  range?: [number, number];
  whole?: boolean;
  log: boolean;
}

/** What the matcher ranks by, where that is not Ω. */
function scoreWhereOther(steps: Steps): Column {
  return steps.score_best.map((score, i) => (score === steps.omega_best[i] ? null : score));
}

const share: [number, number] = [0, 1];

const curves: Curve[] = [
  { id: "match_ms", title: "Time per match", unit: "ms", axis: "time, ms", values: (s) => s.match_ms, log: false },
  {
    id: "omega_best",
    title: "Best quality Ω",
    axis: "share of points",
    values: (s) => s.omega_best,
    second: { name: "score", values: scoreWhereOther },
    range: share,
    log: false,
  },
  { id: "omega_max", title: "Threshold Ω max", axis: "share of points", values: (s) => s.omega_max, range: share, log: false },
  { id: "omega_place", title: "Known place Ω′", axis: "share of points", values: (s) => s.omega_place, range: share, log: false },
  { id: "translation", title: "Error of translation", unit: "m", axis: "error, m", values: (s) => s.translation_error_m, log: true },
  { id: "rotation", title: "Error of rotation", unit: "°", axis: "error, °", values: (s) => s.rotation_error_deg, log: true },
  { id: "clusters", title: "Clusters", axis: "clusters", whole: true, values: (s) => s.clusters, log: true },
];

/** A run's trial that starts where the chosen one does, and whether its curves are drawn. */
interface Found {
  run: Run;
  index: number;
  trial: Trial;
  isChosen: boolean;
  isOn: boolean;
}

const mostNames = 12;

type Shown = Found & { steps: Steps };

const mostAtFirst = 6;

/** Low enough for all of them, two in a row, to be seen at once where the screen is not too small. */
function chartHeight(): number {
  const besides = 240; // px, of the page
  const ofPanel = 32;
  const rows = Math.ceil(curves.length / 2);
  return Math.min(Math.max((window.innerHeight - besides) / rows - ofPanel, 118), 200);
}

export class Curves {
  readonly element: HTMLElement;
  private readonly panels: Panel[];
  private readonly picker = el("fieldset", { class: "runs" });
  /** Those that the reader has switched on or off; of the others the first are on. */
  private readonly switched = new Map<number, boolean>();
  private hasAllNames = false;

  constructor(private readonly store: Store) {
    this.panels = curves.map((curve) => new Panel(curve, store));
    this.element = el(
      "div",
      { class: "curves" },
      this.picker,
      el("div", { class: "panels" }, ...this.panels.map((panel) => panel.element)),
    );
    store.subscribe((change) => this.update(change));
  }

  rebuild(): void {
    const found = this.find();
    this.drawPicker(found);
    const on = found.filter(({ isOn }) => isOn);
    const missing = on.map(({ trial }) => trial).filter(({ chunk }) => chunk !== undefined);
    if (missing.length > 0) {
      const before = this.store.trial;
      // What cannot be loaded is told on the map.
      void this.store.load(missing).then(() => before === this.store.trial && missing.some(({ chunk }) => chunk === undefined) && this.rebuild());
    }
    const shown = on.flatMap((each): Shown[] => (each.trial.columns ? [{ ...each, steps: each.trial.columns }] : []));
    for (const panel of this.panels) panel.rebuild(shown);
  }

  private update(change: Change): void {
    if (change.trial || change.shown) this.rebuild();
    else if (change.step) for (const panel of this.panels) panel.showStep();
  }

  /** The trials of runs that start where the chosen one does. */
  private find(): Found[] {
    const { report, selected, trial, shown } = this.store;
    const found: Found[] = [];
    report.runs.forEach((run, index) => {
      const isChosen = index === selected.run;
      if (!isChosen && !shown.includes(run)) return;
      const own = run.trials[isChosen ? selected.trial : matchingTrial(trial, run)];
      if (own?.columns || own?.chunk !== undefined) found.push({ run, index, trial: own, isChosen, isOn: false });
    });
    found.forEach((each, i) => (each.isOn = each.isChosen || (this.switched.get(each.index) ?? i < mostAtFirst)));
    return found;
  }

  private drawPicker(found: Found[]): void {
    this.picker.hidden = found.length < 2;
    const entry = ({ run, index, isChosen, isOn }: Found): HTMLElement => {
      const box = el("input", {
        type: "checkbox",
        checked: isOn,
        disabled: isChosen,
        change: () => {
          this.switched.set(index, box.checked);
          this.rebuild();
        },
      });
      return el("label", {}, box, lineSample(index), run.name);
    };
    const isNamed = (each: Found, i: number): boolean => this.hasAllNames || each.isOn || i < mostNames;
    const named = found.filter(isNamed);
    const more = el("button", { type: "button", click: () => this.showAllNames() }, `${found.length - named.length} more`);
    replace(this.picker, el("legend", {}, "Curves of"), ...named.map(entry), named.length < found.length && more);
  }

  private showAllNames(): void {
    this.hasAllNames = true;
    this.rebuild();
  }
}

/** How the i-th run's lines look. */
export function lineSample(i: number): SVGElement {
  const line = svg("line", { x1: 0, y1: 5, x2: 26, y2: 5, "stroke-width": 2.5, "stroke-dasharray": runLine(i).dash.join(" ") });
  line.style.stroke = runColour(i);
  return svg("svg", { width: 26, height: 10, "aria-hidden": "true" }, line);
}

class Panel {
  readonly element: HTMLElement;
  private readonly value = el("output", {});
  private readonly target = el("div", { class: "plot" });
  private readonly cursor = el("div", { class: "step-line" });
  private drawn: ReturnType<typeof chart> | null = null;
  private shown: Shown[] = [];

  constructor(
    private readonly curve: Curve,
    private readonly store: Store,
  ) {
    const log = el("input", {
      type: "checkbox",
      checked: curve.log,
      change: () => {
        this.curve.log = log.checked;
        this.rebuild(this.shown);
      },
    });
    const title = el("h3", {}, explained(el("span", {}, curve.title)), " ", this.value);
    this.element = el("div", { class: "panel", "data-curve": curve.id }, title, el("label", {}, log, "log"), this.target);
    this.target.addEventListener("click", (event) => this.chooseStepAt(event));
  }

  rebuild(shown: Shown[]): void {
    this.shown = shown;
    this.drawn?.destroy();
    const { curve } = this;
    const length = Math.max(0, ...shown.map(({ steps }) => steps.step.length));
    const x = Array.from({ length }, (_, i) => i);
    const padded = (values: Column): Column => x.map((i) => values[i] ?? null);
    const line = ({ run, index, isChosen }: Shown): Pick<Line, "label" | "colour" | "dash" | "width"> => ({
      label: run.name,
      ...runLine(index),
      width: isChosen ? 2 : 1.25,
    });
    const lines: Line[] = shown.map((s) => ({ ...line(s), values: padded(curve.values(s.steps)) }));
    const { second } = curve;
    if (second) {
      for (const s of shown)
        lines.push({ ...line(s), dash: [3, 3], width: 1.25, values: padded(second.values(s.steps)) });
    }
    this.drawn = chart(this.target, {
      x,
      lines,
      xLabel: "step",
      label: curve.axis,
      logY: curve.log,
      range: curve.range,
      height: chartHeight(),
      whole: true,
      sync: "steps",
      hooks: { draw: [(plot) => this.drawLocalized(plot), () => this.placeCursor()] },
    });
    this.drawn.plot.over.append(this.cursor);
    this.showStep();
  }

  showStep(): void {
    const { steps } = this.store;
    const { step } = this.store.selected;
    const number = this.curve.whole ? count : significant;
    const told = (values: Column, unit = ""): string => `${number(values[step])}${unit && ` ${unit}`}`;
    const texts = steps && steps.step.length > 0 ? [told(this.curve.values(steps), this.curve.unit)] : [];
    const { second } = this.curve;
    const values = steps && second?.values(steps);
    if (texts.length > 0 && values?.[step] != null) texts.push(`${second?.name} (dashed) ${told(values)}`);
    replace(this.value, texts.join(", "));
    this.placeCursor();
  }

  private placeCursor(): void {
    if (!this.drawn) return;
    const { plot } = this.drawn;
    const left = plot.valToPos(this.store.selected.step, "x");
    this.cursor.hidden = !(left >= 0 && left <= plot.over.clientWidth);
    this.cursor.style.transform = `translateX(${left}px)`;
  }

  /** The line where the chosen run was localized first: black in the paper, and where the page is light. */
  private drawLocalized(plot: uPlot): void {
    const step = firstLocalized(this.store.steps);
    const { min, max } = plot.scales.x;
    if (step < 0 || min == null || max == null || step < min || step > max) return;
    const { ctx, bbox } = plot;
    const x = plot.valToPos(step, "x", true);
    ctx.save();
    ctx.strokeStyle = themeColour("ink");
    ctx.lineWidth = 2 * devicePixelRatio;
    ctx.setLineDash([]);
    drawSegment(ctx, x, bbox.top, x, bbox.top + bbox.height);
    ctx.restore();
  }

  /** Dragging zooms; only what ends where it began is a click. */
  private chooseStepAt(event: MouseEvent): void {
    if (!this.drawn || !(event.target instanceof Node) || !this.drawn.plot.over.contains(event.target)) return;
    const { plot } = this.drawn;
    if (plot.select.width > 0) return;
    const box = plot.over.getBoundingClientRect();
    this.store.chooseStep(Math.round(plot.posToVal(event.clientX - box.left, "x")));
  }
}

// The curves of the paper's Fig. 3, step by step, with one cursor that the slider shares.
import type uPlot from "uplot";
import { chart, type Line } from "./charts";
import { runColour, runLine, themeColour } from "./colours";
import { firstLocalized, type Column, type Run, type Steps } from "./data";
import { el, replace } from "./elements";
import { count, significant } from "./numbers";
import { matchingTrial, type Change, type Store } from "./store";
import { explained } from "./words";

interface Curve {
  id: string;
  title: string;
  unit: string;
  values: (steps: Steps) => Column;
  /** Drawn dashed; on an axis to the right, unless it shares that on the left. */
  second?: { name?: string; unit: string; side: "left" | "right"; values: (steps: Steps) => Column };
  range?: [number, number];
  whole?: boolean;
  log: boolean;
}

/** What the matcher ranks by, where that is not Ω. */
function scoreWhereOther(steps: Steps): Column {
  return steps.score_best.map((score, i) => (score === steps.omega_best[i] ? null : score));
}

const curves: Curve[] = [
  { id: "match_ms", title: "Time per match", unit: "ms", values: (s) => s.match_ms, log: false },
  {
    id: "omega_best",
    title: "Best quality Ω",
    unit: "",
    values: (s) => s.omega_best,
    second: { name: "score", unit: "", side: "left", values: scoreWhereOther },
    range: [0, 1],
    log: false,
  },
  { id: "omega_max", title: "Threshold Ω max", unit: "", values: (s) => s.omega_max, range: [0, 1], log: false },
  { id: "omega_place", title: "Known place Ω′", unit: "", values: (s) => s.omega_place, range: [0, 1], log: false },
  {
    id: "error",
    title: "Error",
    unit: "m",
    values: (s) => s.translation_error_m,
    second: { unit: "°", side: "right", values: (s) => s.rotation_error_deg },
    log: true,
  },
  { id: "clusters", title: "Clusters", unit: "", whole: true, values: (s) => s.clusters, log: true },
];

/** A run's trial that starts where the chosen one does. */
interface Shown {
  run: Run;
  index: number;
  steps: Steps;
  isChosen: boolean;
}

const mostAtFirst = 6;
const tallScreen = 1100; // px

export class Curves {
  readonly element: HTMLElement;
  private readonly panels: Panel[];
  private readonly picker = el("fieldset", { class: "runs" });
  private readonly hidden: Set<number>;
  private shown: Shown[] = [];

  constructor(private readonly store: Store) {
    const runs = store.report.runs;
    this.hidden = new Set(runs.map((_, i) => i).filter((i) => i >= mostAtFirst));
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
    this.shown = this.find();
    this.drawPicker();
    for (const panel of this.panels) panel.rebuild(this.shown);
  }

  private update(change: Change): void {
    if (change.trial) this.rebuild();
    else if (change.step) for (const panel of this.panels) panel.showStep();
  }

  private find(): Shown[] {
    const { report, selected, trial } = this.store;
    const shown: Shown[] = [];
    report.runs.forEach((run, index) => {
      const isChosen = index === selected.run;
      if (this.hidden.has(index) && !isChosen) return;
      const steps = run.trials[isChosen ? selected.trial : matchingTrial(trial, run)]?.columns;
      if (steps) shown.push({ run, index, steps, isChosen });
    });
    return shown;
  }

  private drawPicker(): void {
    const { runs } = this.store.report;
    this.picker.hidden = runs.length < 2;
    const entry = (run: Run, i: number): HTMLElement => {
      const box = el("input", {
        type: "checkbox",
        checked: !this.hidden.has(i) || i === this.store.selected.run,
        disabled: i === this.store.selected.run,
        change: () => {
          if (box.checked) this.hidden.delete(i);
          else this.hidden.add(i);
          this.rebuild();
        },
      });
      return el("label", {}, box, lineSample(i), run.name);
    };
    replace(this.picker, el("legend", {}, "Curves of"), ...runs.map(entry));
  }
}

/** How the i-th run's lines look. */
export function lineSample(i: number): SVGElement {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  const line = document.createElementNS("http://www.w3.org/2000/svg", "line");
  const { dash } = runLine(i);
  const set = (element: SVGElement, attributes: Record<string, string>): void => {
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  };
  set(svg, { width: "26", height: "10", "aria-hidden": "true", class: "sample" });
  set(line, { x1: "0", y1: "5", x2: "26", y2: "5", "stroke-width": "2.5", "stroke-dasharray": dash.join(" ") });
  line.style.stroke = runColour(i);
  svg.append(line);
  return svg;
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
        lines.push({ ...line(s), dash: [3, 3], width: 1.25, side: second.side, values: padded(second.values(s.steps)) });
    }
    this.drawn = chart(this.target, {
      x,
      lines,
      xLabel: "",
      labels: [curve.unit, second?.side === "right" ? `${second.unit} (dashed)` : ""],
      logY: curve.log,
      range: curve.range,
      height: window.innerHeight < tallScreen ? 150 : 200,
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
    const told = (values: Column, unit: string): string => `${number(values[step])}${unit && ` ${unit}`}`;
    const texts = steps && steps.step.length > 0 ? [told(this.curve.values(steps), this.curve.unit)] : [];
    const { second } = this.curve;
    if (steps && texts.length > 0 && second) {
      const values = second.values(steps);
      if (!second.name) texts.push(told(values, second.unit));
      else if (values[step] != null) texts.push(`${second.name} (dashed) ${told(values, second.unit)}`);
    }
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
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
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

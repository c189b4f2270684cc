// Where the trials of the chosen run began, and how they ended: each mark leads to its trial.
import { ofRight } from "./answers";
import { ratingColour, themeColour } from "./colours";
import { metres, type Outcome, type Run, type Trial } from "./data";
import { colourBar, el, replace } from "./elements";
import { saveMenu } from "./export";
import { boundingBox, union, type Box } from "./geometry";
import { count, fixed } from "./numbers";
import { PointLayer } from "./point_layer";
import type { Store } from "./store";
import { svg } from "./svg";
import { svgFile } from "./svg_file";

const margin = 14; // px

type Kind = Outcome | "running";

/** Colours after Okabe and Ito; shapes that differ without them, inside a circle of radius 1. */
const kinds: Record<Kind, { colour: string; shape: string; isOpen?: boolean }> = {
  right: { colour: "--run-2", shape: "M1 0A1 1 0 1 1 -1 0A1 1 0 1 1 1 0Z" },
  wrong: { colour: "--run-1", shape: "M-.9 -.9H.9V.9H-.9Z" },
  undecided: { colour: "--run-4", shape: "M0 -1.15L1.05 .75H-1.05Z" },
  failed: { colour: "--run-3", shape: "M-.9 -.9L.9 .9M-.9 .9L.9 -.9", isOpen: true },
  declared: { colour: "--run-0", shape: "M0 -1.2L1.2 0L0 1.2L-1.2 0Z" },
  running: { colour: "--soft", shape: "M1 0A1 1 0 1 1 -1 0A1 1 0 1 1 1 0Z", isOpen: true },
};
/** Rare ones are drawn last, on top. */
const order: Kind[] = ["running", "right", "declared", "undecided", "failed", "wrong"];

interface Start {
  /** Index into the run's trials. */
  index: number;
  x: number;
  y: number;
  kind: Kind;
}

function kindOf(trial: Trial): Kind {
  return trial.outcome ?? "running";
}

function startsOf(trials: Trial[]): Start[] {
  return trials.flatMap((trial, index) => {
    const at = trial.start.reference;
    return at ? [{ index, x: at.x, y: at.y, kind: kindOf(trial) }] : [];
  });
}

const rightSteps = ofRight(({ steps }) => steps);

const fewest = { onMap: 2, alone: 5 };

/** One start is no map, and a few without walls around them are none either. */
export function hasStarts(run: Run): boolean {
  return startsOf(run.trials).length >= (run.map === undefined ? fewest.alone : fewest.onMap);
}

function told(trial: Trial): string {
  const steps = trial.steps === undefined ? "" : ` ${trial.outcome === "undecided" ? "in" : "after"} ${count(trial.steps)} ${trial.steps === 1 ? "step" : "steps"}`;
  const error = trial.translation_error_m === undefined ? "" : `, error ${fixed(trial.translation_error_m, 2)} m`;
  return `trial ${trial.trial}: ${kindOf(trial)}${steps}${error}`;
}

export class StartsMap {
  readonly element: HTMLElement;
  private readonly canvas = el("canvas", { "aria-hidden": "true" });
  private readonly drawing = svg("svg", { role: "group", "aria-label": "Starts of the trials; arrow keys go from one to the next, Enter opens it" });
  private readonly stage = el("div", { class: "starts-stage" }, this.canvas);
  private readonly tip = el("div", { class: "tip", hidden: true });
  private readonly legend = el("p", { class: "legend" });
  private readonly choices = el("span", { class: "choices", role: "group", "aria-label": "Colour of the starts" });
  private bySteps = false;
  private starts: Start[] = [];
  private marks = new Map<number, SVGElement>();

  constructor(
    private readonly store: Store,
    private readonly open: (trial: number) => void,
  ) {
    this.stage.append(this.drawing, this.tip);
    const title = "Where trials began";
    const menu = saveMenu(() => title, () => svgFile(this.drawing, title, this.canvas));
    this.element = el("div", { class: "panel starts", "data-share": "starts" }, el("h3", {}, title), menu, this.choices, this.stage, this.legend);
    this.listen();
    store.subscribe((change) => {
      if (change.run) this.rebuild();
      else if (change.trial) this.mark();
    });
    new ResizeObserver(() => this.draw()).observe(this.stage);
  }

  rebuild(): void {
    this.starts = startsOf(this.store.run.trials);
    this.starts.sort((a, b) => order.indexOf(a.kind) - order.indexOf(b.kind) || a.index - b.index);
    this.element.hidden = !hasStarts(this.store.run);
    this.drawChoices();
    this.draw();
    this.drawLegend();
  }

  private draw(): void {
    const width = this.stage.clientWidth;
    const height = this.stage.clientHeight;
    if (width === 0) return;
    const box = this.box();
    const spanX = Math.max(box.high.x - box.low.x, 1);
    const spanY = Math.max(box.high.y - box.low.y, 1);
    const scale = Math.min((width - 2 * margin) / spanX, (height - 2 * margin) / spanY);
    const u0 = width / 2 - ((box.low.x + box.high.x) / 2) * scale;
    const v0 = height / 2 + ((box.low.y + box.high.y) / 2) * scale;
    this.drawMap(width, height, u0, v0, scale);
    const radius = this.starts.length > 1000 ? 3 : this.starts.length > 200 ? 4 : 5;
    const most = this.mostSteps();
    const hadFocus = this.drawing.contains(document.activeElement);
    this.marks = new Map();
    const shapes = this.starts.map((start) => {
      const trial = this.store.run.trials[start.index];
      const { shape, isOpen } = kinds[start.kind];
      const colour = this.colourOf(trial, start.kind, most);
      const mark = svg("path", {
        d: shape,
        transform: `translate(${(u0 + start.x * scale).toFixed(1)} ${(v0 - start.y * scale).toFixed(1)}) scale(${radius})`,
        "data-trial": start.index,
        "data-outcome": start.kind,
        role: "button",
        tabindex: -1,
        "aria-label": told(trial),
      });
      mark.style.fill = isOpen ? "none" : colour;
      mark.style.stroke = isOpen ? colour : "var(--paper)";
      mark.style.strokeWidth = isOpen ? "2px" : "1px";
      this.marks.set(start.index, mark);
      return mark;
    });
    this.drawing.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.drawing.replaceChildren(...shapes);
    this.mark();
    if (hadFocus) this.marks.get(this.store.selected.trial)?.focus();
  }

  private box(): Box {
    const { map } = this.store;
    const ofStarts = boundingBox(this.starts.map((s) => s.x), this.starts.map((s) => s.y));
    const all = union(ofStarts, map ? boundingBox(map.x, map.y, metres) : null);
    return all ?? { low: { x: 0, y: 0 }, high: { x: 1, y: 1 } };
  }

  private drawMap(width: number, height: number, u0: number, v0: number, scale: number): void {
    const ratio = window.devicePixelRatio;
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(height * ratio);
    const context = this.canvas.getContext("2d");
    const { map } = this.store;
    if (!context || !map) return;
    const layer = new PointLayer(this.canvas.width, this.canvas.height, { u0: u0 * ratio, v0: v0 * ratio, scale: scale * ratio });
    const { z } = map;
    const all = { x: map.x, y: map.y, begin: 0, end: map.x.length, ...(z ? { isShown: isAmid(z) } : {}) };
    layer.draw(all, { x: 0, y: 0, theta: 0 }, map.spacing_m, 1, themeColour("faint-wall"));
    layer.show(context);
  }

  private mostSteps(): number {
    return Math.max(1, ...rightSteps(this.store.run));
  }

  private colourOf(trial: Trial, kind: Kind, most: number): string {
    if (!this.bySteps) return `var(${kinds[kind].colour})`;
    // Few steps are bright; what was never localized has no number of them.
    return trial.outcome === "right" && trial.steps !== undefined ? stepsColour(trial.steps, most) : "var(--soft)";
  }

  private drawChoices(): void {
    const choice = (bySteps: boolean, text: string): HTMLElement =>
      el(
        "button",
        {
          type: "button",
          "aria-pressed": String(bySteps === this.bySteps),
          click: () => {
            this.bySteps = bySteps;
            this.drawChoices();
            this.draw();
            this.drawLegend();
          },
        },
        text,
      );
    // Where all take as many steps, there is nothing to tell apart.
    const isWorthIt = new Set(rightSteps(this.store.run)).size > 1;
    if (!isWorthIt) this.bySteps = false;
    replace(this.choices, isWorthIt && choice(false, "by outcome"), isWorthIt && choice(true, "by steps"));
  }

  private drawLegend(): void {
    const entries = (Object.keys(kinds) as Kind[]).flatMap((kind) => {
      const n = this.starts.filter((start) => start.kind === kind).length;
      if (n === 0) return [];
      const { shape, isOpen, colour } = kinds[kind];
      const sample = svg("svg", { width: 12, height: 12, viewBox: "-1.4 -1.4 2.8 2.8", "aria-hidden": "true" });
      const path = svg("path", { d: shape });
      const paint = this.bySteps ? "var(--soft)" : `var(${colour})`;
      path.style.fill = isOpen ? "none" : paint;
      path.style.stroke = isOpen ? paint : "none";
      path.style.strokeWidth = "0.5px";
      sample.append(path);
      return [el("span", { class: "entry" }, sample, `${kind} ${count(n)}`)];
    });
    const most = this.mostSteps();
    const bar = colourBar((share) => stepsColour(1 + share * (most - 1), most));
    const without = this.store.run.trials.length - this.starts.length;
    replace(
      this.legend,
      ...entries,
      this.bySteps && el("span", { class: "scale" }, "steps to localize  1 ", bar, ` ${most}`),
      without > 0 && `${count(without)} without a known start`,
    );
  }

  /** The chosen trial has a ring, and is where the tab key leads. */
  private mark(): void {
    const chosen = this.store.selected.trial;
    for (const [index, mark] of this.marks) {
      const isChosen = index === chosen;
      mark.classList.toggle("chosen", isChosen);
      mark.setAttribute("tabindex", isChosen ? "0" : "-1");
      if (isChosen) mark.setAttribute("aria-current", "true");
      else mark.removeAttribute("aria-current");
    }
    if (!this.marks.has(chosen)) this.marks.values().next().value?.setAttribute("tabindex", "0");
    const top = this.marks.get(chosen);
    // Moving what has the focus would take the focus away.
    if (top && top !== document.activeElement) this.drawing.append(top);
  }

  private listen(): void {
    const indexOf = (event: Event): number | null => {
      const mark = event.target instanceof Element ? event.target.closest("[data-trial]") : null;
      return mark ? Number(mark.getAttribute("data-trial")) : null;
    };
    this.drawing.addEventListener("click", (event) => {
      const index = indexOf(event);
      if (index !== null) this.open(index);
    });
    this.drawing.addEventListener("keydown", (event) => {
      const index = indexOf(event);
      if (index === null || event.altKey || event.ctrlKey || event.metaKey) return;
      const step: Record<string, number> = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 };
      if (event.key === "Enter" || event.key === " ") this.open(index);
      else if (event.key in step) this.focusNext(index, step[event.key]);
      else return;
      event.preventDefault();
      event.stopPropagation();
    });
    const show = (event: Event): void => {
      const index = indexOf(event);
      if (index === null) this.tip.hidden = true;
      else this.showTip(index);
    };
    this.drawing.addEventListener("pointerover", show);
    this.drawing.addEventListener("focusin", show);
    for (const name of ["pointerleave", "focusout"]) this.drawing.addEventListener(name, () => (this.tip.hidden = true));
  }

  /** In the order of the trials. */
  private focusNext(index: number, by: number): void {
    const all = [...this.marks.keys()].sort((a, b) => a - b);
    const next = all[(all.indexOf(index) + by + all.length) % all.length];
    this.marks.get(next)?.focus();
  }

  private showTip(index: number): void {
    const mark = this.marks.get(index);
    if (!mark) return;
    replace(this.tip, told(this.store.run.trials[index]));
    this.tip.hidden = false;
    const stage = this.stage.getBoundingClientRect();
    const at = mark.getBoundingClientRect();
    const left = Math.min(at.right - stage.left + 6, stage.width - this.tip.offsetWidth - 4);
    const top = Math.min(at.bottom - stage.top + 6, stage.height - this.tip.offsetHeight - 4);
    this.tip.style.transform = `translate(${Math.max(0, left)}px, ${Math.max(0, top)}px)`;
  }
}

/** Neither floor nor ceiling, which would hide the walls. */
function isAmid(z: number[]): (i: number) => boolean {
  const sorted = Int32Array.from(z).sort();
  const at = (share: number): number => sorted[Math.floor(share * (sorted.length - 1))];
  const [low, high] = [at(0.005), at(0.995)];
  return (i) => z[i] > low + 0.2 * (high - low) && z[i] < low + 0.7 * (high - low);
}

/** From viridis's bright end, one step, to its dark one; without the yellow that is lost on white. */
function stepsColour(steps: number, most: number): string {
  return ratingColour(0.88 * (1 - (steps - 1) / Math.max(1, most - 1)));
}

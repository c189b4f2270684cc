// Charts of shares of all trials or starts: how they grow, or with their intervals.
import type uPlot from "uplot";
import { chart, font, type ChartOptions, type Line } from "./charts";
import { runLine, themeColour } from "./colours";
import type { Proportion } from "./data";
import { el } from "./elements";
import { drawSegment } from "./pen";
import { cumulativeShare } from "./shares";

export interface Sample {
  label: string;
  index: number;
  values: number[];
  /** What the share is of; more than there are values if some never come. */
  of: number;
}

export class SharePanel {
  readonly element: HTMLElement;
  private readonly target = el("div", { class: "plot" });
  private drawn: ReturnType<typeof chart> | null = null;

  constructor(
    id: string,
    title: string,
    private readonly axes: Partial<ChartOptions>,
    private readonly content: () => Pick<ChartOptions, "x" | "lines" | "hooks">,
  ) {
    this.element = el("div", { class: "panel", "data-share": id }, el("h3", {}, title), this.target);
  }

  rebuild(): void {
    this.drawn?.destroy();
    this.drawn = chart(this.target, { xLabel: "", label: "share", range: [0, 1], height: 190, ...this.content(), ...this.axes });
  }
}

/** What part of a sample is no larger than each value. */
export function shareChart(id: string, title: string, samples: Sample[], axes: Partial<ChartOptions>): SharePanel {
  return new SharePanel(id, title, axes, () => {
    const all = samples.flatMap((sample) => sample.values);
    const x = [...new Set(axes.logX ? all.filter((v) => v > 0) : [0, ...all])].sort((a, b) => a - b);
    const lines = samples.map((sample): Line => ({
      label: sample.label,
      ...runLine(sample.index),
      values: cumulativeShare(sample, x),
      stepped: true,
    }));
    return { x, lines };
  });
}

/** Shares at 1, 2 and so on. */
export function levelChart(
  id: string,
  title: string,
  samples: { label: string; index: number; values: (number | null)[] }[],
  axes: Partial<ChartOptions>,
): SharePanel {
  return new SharePanel(id, title, axes, () => {
    const x = Array.from({ length: Math.max(...samples.map(({ values }) => values.length)) }, (_, i) => i + 1);
    return { x, lines: samples.map(({ label, index, values }): Line => ({ label, ...runLine(index), values })) };
  });
}

/** A share with its interval. */
export interface Mark {
  x: number;
  rate: Proportion;
  /** Of the colour. */
  index: number;
  shape: "●" | "■";
  name?: string;
  /** Marks of one colour are joined by a line. */
  isJoined?: boolean;
  /** Has a ▼ above it. */
  isNoted?: boolean;
}

export function intervalChart(id: string, title: string, marks: Mark[], axes: Partial<ChartOptions>): SharePanel {
  return new SharePanel(id, title, axes, () => {
    const x = [...new Set(marks.map((mark) => mark.x))].sort((a, b) => a - b);
    const nothing: Line = { label: "share", colour: themeColour("ink"), dash: [], values: x.map(() => null) };
    return { x, lines: [nothing], hooks: { draw: [(plot) => drawMarks(plot, marks)] } };
  });
}

function drawMarks(plot: uPlot, marks: Mark[]): void {
  plot.ctx.save();
  marks.forEach((mark, i) => {
    drawMark(plot, mark);
    const before = marks.slice(0, i).filter(({ index }) => index === mark.index).pop();
    if (mark.isJoined && before) drawLine(plot, before, mark);
  });
  drawNames(plot, marks);
  plot.ctx.restore();
}

function drawLine(plot: uPlot, from: Mark, to: Mark): void {
  const { ctx } = plot;
  ctx.lineWidth = devicePixelRatio;
  const at = ({ x, rate }: Mark): [number, number] => [plot.valToPos(x, "x", true), plot.valToPos(rate.value, "y", true)];
  drawSegment(ctx, ...at(from), ...at(to));
}

function drawMark(plot: uPlot, { x: at, rate, index, shape, isNoted }: Mark): void {
  const { ctx } = plot;
  const ratio = devicePixelRatio;
  const x = plot.valToPos(at, "x", true);
  const [low, value, high] = [rate.low, rate.value, rate.high].map((v) => plot.valToPos(v, "y", true));
  ctx.strokeStyle = ctx.fillStyle = runLine(index).colour;
  ctx.lineWidth = 2 * ratio;
  drawSegment(ctx, x, low, x, high);
  ctx.beginPath();
  if (shape === "●") ctx.arc(x, value, 4 * ratio, 0, 2 * Math.PI);
  else ctx.rect(x - 3 * ratio, value - 3 * ratio, 6 * ratio, 6 * ratio);
  ctx.fill();
  if (isNoted) write(plot, "▼", x, high - 8 * ratio);
}

function write({ ctx }: uPlot, text: string, x: number, y: number): void {
  ctx.font = font.replace(/^\d+/, (size) => String(Number(size) * devicePixelRatio));
  ctx.fillStyle = themeColour("ink");
  ctx.textAlign = "center";
  ctx.textBaseline = "middle";
  ctx.fillText(text, x, y);
}

/** Beside the marks, where there is room: neither another mark nor another name. */
function drawNames(plot: uPlot, marks: Mark[]): void {
  const ratio = devicePixelRatio;
  const { left, top, width, height } = plot.bbox;
  const places = marks.map(({ x, rate }) => ({ x: plot.valToPos(x, "x", true), y: plot.valToPos(rate.value, "y", true) }));
  const taken = places.map(({ x, y }) => ({ from: x - 5 * ratio, to: x + 5 * ratio, y }));
  marks.forEach(({ name }, i) => {
    if (!name) return;
    const { x, y } = places[i];
    const long = 6.4 * ratio * name.length;
    const beside = [x + 8 * ratio, x - 8 * ratio - long].map((from) => ({ from, to: from + long, y }));
    const above = [-14, 14, -27, 27, -40, 40].map((down) => ({ from: x - long / 2, to: x + long / 2, y: y + down * ratio }));
    const place = [...beside, ...above].find(
      ({ from, to, y: at }) =>
        from >= left && to <= left + width && at > top && at < top + height && taken.every((other) => other.to < from || other.from > to || Math.abs(other.y - at) > 11 * ratio),
    );
    if (!place) return;
    taken.push(place);
    write(plot, name, (place.from + place.to) / 2, place.y);
  });
}

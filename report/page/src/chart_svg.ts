// A chart as an SVG file, from what uPlot has made of it: the ticks and scales are the same as on the page.
import type uPlot from "uplot";
import { font, type ChartOptions, type Line } from "./charts";
import { themeColour } from "./colours";
import { drawSegment, SvgPen, type Pen } from "./pen";

/** What uPlot knows of an axis that it has drawn, but does not say in its types. */
interface DrawnAxis {
  side?: number;
  label?: string;
  _splits?: (number | null)[] | null;
  _values?: (string | null)[] | null;
}

const titleHeight = 24;

export function chartSvg(plot: uPlot, options: ChartOptions, title: string): string {
  const named = namesOf(options.lines);
  const legend = named.length > 1 ? 16 * named.length + 6 : 0;
  const pen = new SvgPen(plot.width, plot.height + titleHeight + legend);
  pen.font = `bold ${font}`;
  pen.fillStyle = themeColour("ink");
  pen.fillText(title.trim(), 8, 16);
  pen.font = font;
  pen.below(titleHeight, () => drawPlot(pen, plot, options));
  if (legend > 0) named.forEach((line, i) => drawName(pen, line, plot.height + titleHeight + 16 * i + 8));
  return pen.file(title.trim(), themeColour("paper"));
}

/** Runs have a name each, whatever lines they have. */
function namesOf(lines: Line[]): Line[] {
  return lines.filter(({ label }, i) => lines.findIndex((other) => other.label === label) === i);
}

function drawName(pen: Pen, line: Line, y: number): void {
  pen.strokeStyle = line.colour;
  pen.lineWidth = 2;
  pen.setLineDash(line.dash);
  drawSegment(pen, 12, y, 38, y);
  pen.setLineDash([]);
  pen.fillStyle = themeColour("ink");
  pen.textAlign = "start";
  pen.textBaseline = "middle";
  pen.fillText(line.label, 46, y);
}

function drawPlot(pen: SvgPen, plot: uPlot, options: ChartOptions): void {
  const ratio = devicePixelRatio;
  const [left, top, width, height] = [plot.bbox.left, plot.bbox.top, plot.bbox.width, plot.bbox.height].map((v) => v / ratio);
  const box = { left, top, width, height };
  for (const axis of plot.axes as DrawnAxis[]) drawAxis(pen, plot, axis, box);
  pen.within(box, 1, () => {
    for (const line of options.lines) drawLine(pen, plot, options, line, box);
  });
  // Hooks draw in the canvas's own pixels.
  const drawn = Object.create(plot, { ctx: { value: pen } }) as uPlot;
  pen.within(plot.bbox, 1 / ratio, () => options.hooks?.draw?.forEach((hook) => hook?.(drawn)));
}

function drawAxis(pen: Pen, plot: uPlot, axis: DrawnAxis, box: { left: number; top: number; width: number; height: number }): void {
  const isAcross = axis.side === 2 || axis.side === 0;
  const scale = isAcross ? "x" : "y";
  const bottom = box.top + box.height;
  const edge = box.left - 6;
  pen.lineWidth = 1;
  pen.strokeStyle = themeColour("grid");
  pen.fillStyle = themeColour("ink");
  pen.textAlign = isAcross ? "center" : "end";
  pen.textBaseline = isAcross ? "top" : "middle";
  (axis._splits ?? []).forEach((value, i) => {
    if (value === null) return;
    const at = plot.valToPos(value, scale) + (isAcross ? box.left : box.top);
    if (isAcross) drawSegment(pen, at, box.top, at, bottom);
    else drawSegment(pen, box.left, at, box.left + box.width, at);
    const text = axis._values?.[i];
    if (text) pen.fillText(text, isAcross ? at : edge, isAcross ? bottom + 6 : at);
  });
  if (!axis.label) return;
  pen.textAlign = isAcross ? "center" : "start";
  pen.textBaseline = "alphabetic";
  pen.fillText(axis.label, isAcross ? box.left + box.width / 2 : 2, isAcross ? plot.height - 2 : box.top - 4);
}

/** As uPlot does: what is missing leaves a gap, except in steps, which go on. */
function drawLine(pen: Pen, plot: uPlot, options: ChartOptions, line: Line, box: { left: number; top: number }): void {
  const isLog = options.logY === true;
  pen.strokeStyle = pen.fillStyle = line.colour;
  pen.lineWidth = line.width ?? 1.5;
  pen.setLineDash(line.dash);
  pen.beginPath();
  let before: number | null = null;
  options.x.forEach((x, i) => {
    const value = line.values[i];
    const isMissing = value === null || (isLog && value <= 0) || (options.logX === true && x <= 0);
    if (isMissing) {
      if (!line.stepped) before = null;
      return;
    }
    const u = plot.valToPos(x, "x") + box.left;
    const v = plot.valToPos(value, "y") + box.top;
    if (before === null) pen.moveTo(u, v);
    else {
      if (line.stepped) pen.lineTo(u, before);
      pen.lineTo(u, v);
    }
    before = v;
  });
  pen.stroke();
  pen.setLineDash([]);
}

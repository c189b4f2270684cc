// What a sweep has taught, as files: effects of parameters, and the map of two of them.
import { inkOn, ratingColour, themeColour } from "./colours";
import type { ParameterEffect, SweepMap } from "./data";
import { fixed, percent } from "./numbers";
import { drawSegment, SvgPen } from "./pen";

const font = "12px system-ui, sans-serif";
const letter = 6.8; // px, about
const row = 22;
const margin = 10;
const titleHeight = 28;

const widthOf = (texts: string[]): number => letter * Math.max(...texts.map((text) => text.length));

function titled(width: number, height: number, title: string): SvgPen {
  const pen = new SvgPen(Math.max(width, 1.1 * widthOf([title]) + 2 * margin), height);
  pen.font = `bold ${font}`;
  pen.textBaseline = "middle";
  pen.fillStyle = themeColour("ink");
  pen.fillText(title, margin, titleHeight / 2);
  pen.font = font;
  return pen;
}

function write(pen: SvgPen, words: string, x: number, y: number, align: CanvasTextAlign): void {
  pen.textAlign = align;
  pen.fillText(words, x, y);
}

/** A row for each level: its interval and its mean on an axis of shares. */
export function effectSvg({ levels }: ParameterEffect, title: string): string {
  const left = margin + widthOf([...levels.map(({ label }) => label), "right trials"]) + 16;
  const length = 260;
  const at = (share: number): number => left + share * length;
  const bottom = titleHeight + row * levels.length;
  const pen = titled(left + length + 80, bottom + 2 * row, title);
  levels.forEach((level, i) => {
    const y = titleHeight + row * (i + 0.5);
    const { value, low, high } = level.success_rate;
    pen.fillStyle = themeColour("ink");
    write(pen, level.label, left - 12, y, "end");
    write(pen, level.trials > 0 ? percent(value) : "–", left + length + 60, y, "end");
    if (level.trials === 0) return;
    pen.strokeStyle = pen.fillStyle = themeColour("estimate");
    pen.lineWidth = 3;
    drawSegment(pen, at(low), y, at(high), y);
    pen.beginPath();
    pen.arc(at(value), y, 4.5);
    pen.fill();
  });
  pen.strokeStyle = themeColour("soft");
  pen.lineWidth = 1;
  drawSegment(pen, left, bottom, left + length, bottom);
  pen.fillStyle = themeColour("soft");
  for (const tick of [0, 0.25, 0.5, 0.75, 1]) write(pen, `${100 * tick} %`, at(tick), bottom + row / 2, "center");
  write(pen, "right trials", left - 24, bottom + row / 2, "end");
  return pen.file(title, themeColour("paper"));
}

/** A cell for each pair of levels, in the colour of its share. */
export function heatSvg({ rows, columns, cells }: SweepMap, title: string): string {
  const left = margin + widthOf([...rows.levels, rows.label]) + 16;
  const side = Math.max(64, widthOf(columns.levels) + 12);
  const top = titleHeight + 2 * row;
  const high = 30;
  const pen = titled(left + side * columns.levels.length + margin, top + high * rows.levels.length + margin, title);
  pen.font = `italic ${font}`;
  write(pen, columns.label, left + (side * columns.levels.length) / 2, titleHeight + row / 2, "center");
  write(pen, rows.label, left - 12, titleHeight + 1.5 * row, "end");
  pen.font = font;
  columns.levels.forEach((level, c) => write(pen, level, left + side * (c + 0.5), titleHeight + 1.5 * row, "center"));
  rows.levels.forEach((level, r) => {
    const y = top + high * (r + 0.5);
    pen.fillStyle = themeColour("ink");
    write(pen, level, left - 12, y, "end");
    cells[r].forEach(({ trials, success_rate: { value } }, c) => {
      const x = left + side * c;
      if (trials > 0) {
        pen.fillStyle = ratingColour(value);
        pen.fillRect(x, top + high * r, side, high);
      }
      pen.fillStyle = trials > 0 ? inkOn(value) : themeColour("soft");
      write(pen, trials > 0 ? fixed(100 * value, 0) : "–", x + side / 2, y, "center");
    });
  });
  return pen.file(title, themeColour("paper"));
}

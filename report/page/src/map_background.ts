// What lies below everything else on the map: free and unknown space, and lines every so many metres.
import { bytesOf, themeColour } from "./colours";
import type { Grid } from "./data";
import { el } from "./elements";
import { significant } from "./numbers";
import type { Pen } from "./pen";
import { multiples, roundStep } from "./svg";

const mostPixels = 4096; // of a picture's side; browsers have limits

/** From cells to the screen, as canvases and SVG write it. */
type Matrix = [number, number, number, number, number, number];

/** Where the map lies on the screen. */
export interface Screen {
  x: (x: number) => number;
  y: (y: number) => number;
  /** px per m. */
  scale: number;
  width: number;
  height: number;
}

/** The cells of a grid as a picture, a pixel each; the highest row on top. */
export class SpacePicture {
  readonly canvas: HTMLCanvasElement;
  /** Cells along the side of a pixel: large grids have fewer pixels than cells. */
  private readonly cellsPerPixel: number;

  constructor(private readonly grid: Grid) {
    const { width, height } = grid;
    this.cellsPerPixel = Math.ceil(Math.max(width, height, 1) / mostPixels);
    const across = Math.ceil(width / this.cellsPerPixel);
    const down = Math.ceil(height / this.cellsPerPixel);
    this.canvas = el("canvas", { width: across, height: down });
    this.paint(across, down);
  }

  matrix(screen: Screen): Matrix {
    const { origin, resolution, height } = this.grid;
    const c = Math.cos(origin.theta);
    const s = Math.sin(origin.theta);
    const side = resolution * this.cellsPerPixel;
    // The picture's first pixel is the corner upper left; its last row may reach below the grid.
    const top = height * resolution;
    const [x, y] = [origin.x - s * top, origin.y + c * top];
    const k = side * screen.scale;
    return [k * c, -k * s, k * s, k * c, screen.x(x), screen.y(y)];
  }

  private paint(across: number, down: number): void {
    const context = this.canvas.getContext("2d");
    if (!context) return;
    const image = context.createImageData(across, down);
    const free = bytesOf(themeColour("free"));
    const occupied = bytesOf(themeColour("occupied"));
    let cell = 0;
    for (const [, length, kind] of this.grid.cells.matchAll(/(\d+)([ufo])/g)) {
      const end = cell + Number(length);
      if (kind !== "u") this.paintRun(image, cell, end, kind === "f" ? free : occupied, kind === "o");
      cell = end;
    }
    context.putImageData(image, 0, 0);
  }

  /** Where a pixel has several cells, occupied ones show through. */
  private paintRun(image: ImageData, begin: number, end: number, colour: number[], isOnTop: boolean): void {
    const { width, height } = this.grid;
    for (let cell = begin; cell < end; ++cell) {
      const column = Math.floor((cell % width) / this.cellsPerPixel);
      const row = Math.floor((height - 1 - Math.floor(cell / width)) / this.cellsPerPixel);
      const at = 4 * (row * image.width + column);
      if (isOnTop || image.data[at + 3] === 0) image.data.set(colour, at);
    }
  }
}

const closestLines = 70; // px

/** Where lines are, in m. */
function linesOf({ x, y, scale, width, height }: Screen): { step: number; across: number[]; up: number[] } {
  const step = roundStep(closestLines / scale);
  const left = -x(0) / scale;
  const bottom = (y(0) - height) / scale;
  return { step, across: multiples(step, left, left + width / scale), up: multiples(step, bottom, bottom + height / scale) };
}

export function drawGridLines(pen: Pen, screen: Screen): void {
  const { across, up } = linesOf(screen);
  pen.strokeStyle = themeColour("map-grid");
  pen.lineWidth = 1;
  pen.beginPath();
  // In the middle of a pixel a line is one pixel wide.
  const sharp = (at: number): number => Math.round(at) + 0.5;
  for (const x of across) {
    pen.moveTo(sharp(screen.x(x)), 0);
    pen.lineTo(sharp(screen.x(x)), screen.height);
  }
  for (const y of up) {
    pen.moveTo(0, sharp(screen.y(y)));
    pen.lineTo(screen.width, sharp(screen.y(y)));
  }
  pen.stroke();
}

/** The metres of the lines, along the lower and the right edge. */
export function drawGridNumbers(pen: Pen, screen: Screen): void {
  const { step, across, up } = linesOf(screen);
  const told = (value: number): string => (Math.abs(value) < step / 2 ? "0" : String(Number(significant(value, 9)))).replace("-", "−");
  pen.save();
  pen.fillStyle = themeColour("soft");
  pen.font = "10px system-ui, sans-serif";
  pen.textAlign = "center";
  pen.textBaseline = "alphabetic";
  const free = { left: 150, right: 40, top: 180, bottom: 30 }; // of scale bar, buttons and corner
  for (const x of across) {
    const at = screen.x(x);
    if (at > free.left && at < screen.width - free.right) pen.fillText(told(x), at, screen.height - 4);
  }
  pen.textAlign = "right";
  pen.textBaseline = "middle";
  for (const y of up) {
    const at = screen.y(y);
    if (at > free.top && at < screen.height - free.bottom) pen.fillText(told(y), screen.width - 4, at);
  }
  pen.fillText("x, y in m", screen.width - 4, screen.height - 18);
  pen.restore();
}

/** A bar of a round length. */
export function drawScale(context: Pen, screen: Screen): void {
  const longest = 120 / screen.scale;
  const power = 10 ** Math.floor(Math.log10(longest));
  const length = [5, 2, 1].map((n) => n * power).find((l) => l <= longest) ?? power;
  const width = length * screen.scale;
  const y = screen.height - 12;
  context.strokeStyle = context.fillStyle = themeColour("ink");
  context.lineWidth = 2;
  context.beginPath();
  context.moveTo(12, y - 4);
  context.lineTo(12, y);
  context.lineTo(12 + width, y);
  context.lineTo(12 + width, y - 4);
  context.stroke();
  context.font = "12px system-ui, sans-serif";
  context.textAlign = "start";
  context.fillText(`${significant(length, 1)} m`, 16, y - 6);
}

// Very many small squares, written pixel by pixel: tens of thousands a step are too many for a canvas's own calls.
import { bytesOf } from "./colours";
import { metres, type Pose } from "./data";
import type { SvgPen } from "./pen";

/** Where the map lies on the drawing, in its pixels: u = u0 + scale x, v = v0 - scale y. */
export interface Placement {
  u0: number;
  v0: number;
  scale: number;
}

/** Points in whole mm, of which [begin, end) are meant, and of these only those that `isShown` wants. */
interface PointRange {
  x: number[];
  y: number[];
  begin: number;
  end: number;
  isShown?: (i: number) => boolean;
}

/** Takes points in a frame that lies at `pose` in the map, as squares of a side of `size_m`, at least `least` pixels. */
export interface PointSink {
  draw: (points: PointRange, pose: Pose, size_m: number, least: number, colour: string) => void;
}

/** Corners upper left, in pixels, and the side of what is to be drawn. */
function squaresOf(points: PointRange, pose: Pose, size_m: number, least: number, { u0, v0, scale }: Placement) {
  // Rounded up: neighbours leave no gap.
  const size = Math.ceil(Math.max(least, size_m * scale));
  const c = Math.cos(pose.theta) * scale * metres;
  const s = Math.sin(pose.theta) * scale * metres;
  const u = u0 + pose.x * scale - size / 2;
  const v = v0 - pose.y * scale - size / 2;
  const { x, y } = points;
  return { size, left: (i: number) => u + c * x[i] - s * y[i], top: (i: number) => v - s * x[i] - c * y[i] };
}

export class PointLayer implements PointSink {
  private readonly image: ImageData;
  private readonly pixels: Uint32Array;

  constructor(
    private readonly width: number,
    private readonly height: number,
    private readonly placement: Placement,
  ) {
    this.image = new ImageData(width, height);
    this.pixels = new Uint32Array(this.image.data.buffer);
  }

  draw(points: PointRange, pose: Pose, size_m: number, least: number, colour: string): void {
    const { size, left, top } = squaresOf(points, pose, size_m, least, this.placement);
    // In the byte order of the machine.
    const [paint] = new Uint32Array(new Uint8Array(bytesOf(colour)).buffer);
    for (let i = points.begin; i < points.end; ++i) {
      if (points.isShown && !points.isShown(i)) continue;
      this.square(Math.round(left(i)), Math.round(top(i)), size, paint);
    }
  }

  /** Replaces what is drawn. */
  show(context: CanvasRenderingContext2D): void {
    context.putImageData(this.image, 0, 0);
  }

  private square(left: number, top: number, size: number, paint: number): void {
    const begin = Math.max(left, 0);
    const end = Math.min(left + size, this.width);
    if (begin >= end) return;
    for (let v = Math.max(top, 0); v < Math.min(top + size, this.height); ++v)
      this.pixels.fill(paint, v * this.width + begin, v * this.width + end);
  }
}

/** The same in an SVG file; what lies outside is left out. */
export class SvgPoints implements PointSink {
  constructor(
    private readonly pen: SvgPen,
    private readonly width: number,
    private readonly height: number,
    private readonly placement: Placement,
  ) {}

  draw(points: PointRange, pose: Pose, size_m: number, least: number, colour: string): void {
    const { size, left, top } = squaresOf(points, pose, size_m, least, this.placement);
    const corners: { x: number; y: number }[] = [];
    for (let i = points.begin; i < points.end; ++i) {
      if (points.isShown && !points.isShown(i)) continue;
      const [x, y] = [left(i), top(i)];
      if (x + size > 0 && y + size > 0 && x < this.width && y < this.height) corners.push({ x, y });
    }
    this.pen.squares(corners, size, colour);
  }
}

// What drawings are made with: a canvas on the page, or an SVG file.

/** What SvgPen does as canvases do it. */
export type Pen = Pick<CanvasRenderingContext2D, keyof SvgPen & keyof CanvasRenderingContext2D>;

const namespace = "http://www.w3.org/2000/svg";

function inMarkup(text: string): string {
  return text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;").replace(/"/g, "&quot;");
}

/** Tenths of a pixel are more than eyes see. */
export function tenths(value: number): string {
  return String(Math.round(10 * value) / 10);
}

/** A straight line by itself. */
export function drawSegment(pen: Pen, x0: number, y0: number, x1: number, y1: number): void {
  pen.beginPath();
  pen.moveTo(x0, y0);
  pen.lineTo(x1, y1);
  pen.stroke();
}

const anchors: Partial<Record<CanvasTextAlign, string>> = { center: "middle", right: "end", end: "end" };
const baselines: Partial<Record<CanvasTextBaseline, string>> = { middle: "central", top: "hanging" };

/** Writes what a canvas would draw as SVG. */
export class SvgPen implements Pen {
  strokeStyle = "#000000";
  fillStyle = "#000000";
  lineWidth = 1;
  globalAlpha = 1;
  font = "11px system-ui, sans-serif";
  textAlign: CanvasTextAlign = "start";
  textBaseline: CanvasTextBaseline = "alphabetic";
  private dash: number[] = [];
  private path: string[] = [];
  private kept: object[] = [];
  private readonly parts: string[] = [];
  private clips = 0;

  constructor(
    private readonly width: number,
    private readonly height: number,
  ) {}

  beginPath(): void {
    this.path = [];
  }
  moveTo(x: number, y: number): void {
    this.path.push(`M${tenths(x)} ${tenths(y)}`);
  }
  lineTo(x: number, y: number): void {
    this.path.push(`${this.path.length === 0 ? "M" : "L"}${tenths(x)} ${tenths(y)}`);
  }
  closePath(): void {
    this.path.push("Z");
  }
  rect(x: number, y: number, width: number, height: number): void {
    this.path.push(`M${tenths(x)} ${tenths(y)}h${tenths(width)}v${tenths(height)}h${tenths(-width)}Z`);
  }
  /** Whole circles only: nothing else is drawn. */
  arc(x: number, y: number, radius: number): void {
    const r = tenths(radius);
    const across = tenths(2 * radius);
    this.path.push(`M${tenths(x - radius)} ${tenths(y)}a${r} ${r} 0 1 0 ${across} 0a${r} ${r} 0 1 0 -${across} 0Z`);
  }
  stroke(): void {
    const dash = this.dash.length > 0 ? ` stroke-dasharray="${this.dash.join(" ")}"` : "";
    this.draw(`fill="none" stroke="${inMarkup(this.strokeStyle)}" stroke-width="${this.lineWidth}"${dash}`);
  }
  fill(): void {
    this.draw(`fill="${inMarkup(this.fillStyle)}"`);
  }
  fillRect(x: number, y: number, width: number, height: number): void {
    const before = this.path;
    this.path = [];
    this.rect(x, y, width, height);
    this.fill();
    this.path = before;
  }
  fillText(text: string, x: number, y: number): void {
    const anchor = anchors[this.textAlign];
    const baseline = baselines[this.textBaseline];
    const look = `${anchor ? ` text-anchor="${anchor}"` : ""}${baseline ? ` dominant-baseline="${baseline}"` : ""}`;
    const place = `x="${tenths(x)}" y="${tenths(y)}"`;
    this.parts.push(`<text ${place} style="font: ${inMarkup(this.font)}" fill="${inMarkup(this.fillStyle)}"${look}${this.opacity()}>${inMarkup(text)}</text>`);
  }
  setLineDash(dash: number[]): void {
    this.dash = [...dash];
  }
  save(): void {
    const { strokeStyle, fillStyle, lineWidth, globalAlpha, font, textAlign, textBaseline, dash } = this;
    this.kept.push({ strokeStyle, fillStyle, lineWidth, globalAlpha, font, textAlign, textBaseline, dash });
  }
  restore(): void {
    Object.assign(this, this.kept.pop());
  }

  /** What `work` draws, scaled by `factor` and cut at a box of these units. */
  within(box: { left: number; top: number; width: number; height: number }, factor: number, work: () => void): void {
    const id = `clip-${++this.clips}`;
    const place = `x="${tenths(box.left)}" y="${tenths(box.top)}" width="${tenths(box.width)}" height="${tenths(box.height)}"`;
    this.parts.push(`<clipPath id="${id}"><rect ${place}/></clipPath><g transform="scale(${factor})" clip-path="url(#${id})">`);
    work();
    this.parts.push("</g>");
  }

  /** What `work` draws, so much farther down. */
  below(down: number, work: () => void): void {
    this.parts.push(`<g transform="translate(0 ${down})">`);
    work();
    this.parts.push("</g>");
  }

  /** Of squares whose corners upper left are given, all of one colour. */
  squares(corners: { x: number; y: number }[], side: number, colour: string): void {
    const path = corners.map(({ x, y }) => `M${tenths(x)} ${tenths(y)}h${tenths(side)}v${tenths(side)}h${tenths(-side)}Z`);
    if (path.length > 0) this.parts.push(`<path fill="${inMarkup(colour)}" d="${path.join("")}"/>`);
  }

  /** A picture, placed by a matrix as canvases have it; its pixels stay square. */
  picture(canvas: HTMLCanvasElement, matrix: number[]): void {
    const size = `width="${canvas.width}" height="${canvas.height}"`;
    const look = `transform="matrix(${matrix.join(" ")})" style="image-rendering: pixelated"`;
    this.parts.push(`<image ${size} href="${canvas.toDataURL()}" preserveAspectRatio="none" ${look}/>`);
  }

  /** The file; `title` is for those who cannot see it. */
  file(title: string, paper: string): string {
    const size = `width="${tenths(this.width)}" height="${tenths(this.height)}" viewBox="0 0 ${tenths(this.width)} ${tenths(this.height)}"`;
    const back = `<rect width="100%" height="100%" fill="${inMarkup(paper)}"/>`;
    return `<svg xmlns="${namespace}" ${size}><title>${inMarkup(title)}</title>${back}${this.parts.join("\n")}</svg>\n`;
  }

  private draw(look: string): void {
    if (this.path.length > 0) this.parts.push(`<path d="${this.path.join("")}" ${look}${this.opacity()}/>`);
  }

  private opacity(): string {
    return this.globalAlpha < 1 ? ` opacity="${this.globalAlpha}"` : "";
  }
}

// The map with everything that happened on it: the only drawing that is our own.
import { themeColour } from "./colours";
import { frameAt, metres, poseAt, type GlobalMap, type Grid, type Pose } from "./data";
import { el, replace } from "./elements";
import { boundingBox, compose, degrees, inverse, union, type Box } from "./geometry";
import { saveMenu } from "./export";
import { drawGridLines, drawGridNumbers, drawScale, SpacePicture, type Screen } from "./map_background";
import { MapLegend } from "./map_legend";
import { missingOfStep, shownIn, whatIsMissing } from "./missing";
import { NearPlaces } from "./near_places";
import { fixed, significant } from "./numbers";
import { SvgPen, type Pen } from "./pen";
import { PointLayer, SvgPoints, type Placement, type PointSink } from "./point_layer";
import { chosenPose, clustersDrawn, StepDrawing } from "./step_drawing";
import type { Store } from "./store";
import { tellView, type Linked } from "./view_change";
import { iconButton, zoomButtons } from "./zoom_buttons";

const reach = 14; // px, of the pointer

const nearby = 1.0; // m, of a place that was clicked

interface View {
  /** What is in the middle, m. */
  x: number;
  y: number;
  /** px per m. */
  scale: number;
}

/** px per m. */
function withinLimits(scale: number): number {
  return Math.min(Math.max(scale, 0.5), 5000);
}

export class MapView implements Linked {
  readonly element: HTMLElement;
  private readonly canvas = el("canvas", { tabindex: 0, role: "img" });
  private readonly tip = el("div", { class: "tip", hidden: true });
  private readonly note = el("p", { class: "note" });
  private readonly cursor = el("output", { class: "cursor", "aria-hidden": "true" });
  private readonly near: NearPlaces;
  private readonly legend: MapLegend;
  private space: { grid: Grid; theme: string; picture: SpacePicture } | null = null;
  private readonly pointers = new Map<number, PointerEvent>();
  private view: View = { x: 0, y: 0, scale: 20 };
  /** Of the drawing, px; asking the page for them would have it laid out anew each time. */
  private width = 0;
  private height = 0;
  private isFitted = false;
  private fittedMap: GlobalMap | undefined;
  private follows = false;
  private moved = 0;
  /** By the reader: the view is no longer that which shows everything. */
  private isMoved = false;
  private frame = 0;

  constructor(private readonly store: Store) {
    this.near = new NearPlaces(store);
    this.legend = new MapLegend(
      () => {
        tellView(this.element);
        this.draw();
      },
      (follows) => {
        this.follows = follows;
        this.centre();
        this.draw();
      },
    );
    const stage = el(
      "div",
      { class: "stage" },
      this.canvas,
      this.note,
      this.near.element,
      this.tip,
      this.cursor,
      zoomButtons(this, saveMenu(() => "map", () => this.svg())),
    );
    this.element = el("figure", { class: "map" }, stage, this.legend.element);
    this.listen();
    store.subscribe((change) => {
      // Runs on one map are easier to compare if the view stays.
      if (change.run && this.store.map !== this.fittedMap && !store.report.live) this.fit();
      if (change.step) this.tip.hidden = true;
      if (this.follows) this.centre();
      this.draw();
    });
    new ResizeObserver(() => this.resize()).observe(stage);
  }

  zoom(factor: number, at = { x: this.width / 2, y: this.height / 2 }): void {
    const fixedPoint = this.toMap(at.x, at.y);
    this.view.scale = withinLimits(this.view.scale * factor);
    this.view.x = fixedPoint.x - (at.x - this.width / 2) / this.view.scale;
    this.view.y = fixedPoint.y + (at.y - this.height / 2) / this.view.scale;
    this.hasMoved();
  }

  /** By px to the right and down. */
  pan(right: number, down: number): void {
    this.view.x -= right / this.view.scale;
    this.view.y += down / this.view.scale;
    this.hasMoved();
  }

  state(): Record<string, string> {
    const { x, y, scale } = this.view;
    return {
      ...(this.isMoved ? { x: x.toFixed(3), y: y.toFixed(3), zoom: scale.toPrecision(4) } : {}),
      ...this.legend.state(),
    };
  }

  setState(said: URLSearchParams): void {
    this.legend.setState(said);
    const [x, y, zoom] = ["x", "y", "zoom"].map((name) => Number.parseFloat(said.get(name) ?? ""));
    if (Number.isFinite(x) && Number.isFinite(y) && zoom > 0) {
      this.view = { x, y, scale: withinLimits(zoom) };
      this.fittedMap = this.store.map;
      this.isFitted = this.isMoved = true;
      this.draw();
    } else {
      this.fit();
    }
  }

  private hasMoved(): void {
    this.isMoved = true;
    tellView(this.element);
    this.draw();
  }

  /** Shows the whole map, or the whole drive where there is no map. */
  fit(): void {
    const box = this.contents() ?? { low: { x: -5, y: -5 }, high: { x: 5, y: 5 } };
    const margin = 24;
    const width = Math.max(box.high.x - box.low.x, 1);
    const height = Math.max(box.high.y - box.low.y, 1);
    this.isFitted = this.width > 0;
    const wasMoved = this.isMoved;
    this.isMoved = false;
    this.fittedMap = this.store.map;
    this.view = {
      x: (box.low.x + box.high.x) / 2,
      y: (box.low.y + box.high.y) / 2,
      scale: Math.max(Math.min((this.width - 2 * margin) / width, (this.height - 2 * margin) / height), 0.5),
    };
    if (wasMoved) tellView(this.element);
    this.draw();
  }

  /** In the next frame, once, however often it is asked for. */
  draw(): void {
    if (this.frame === 0) this.frame = requestAnimationFrame(() => this.drawNow());
  }

  drawNow(): void {
    this.frame = 0;
    const context = this.canvas.getContext("2d");
    if (!context || !this.isFitted || this.width === 0 || this.element.hidden) return;
    const { x, y, scale } = this.view;
    Object.assign(this.canvas.dataset, { x, y, scale });
    const ratio = this.canvas.width / this.width;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    const points = new PointLayer(this.canvas.width, this.canvas.height, this.placement(ratio));
    this.drawPoints(points, ratio);
    points.show(context);
    this.drawBelow(context);
    this.drawLines(context);
    this.tellState();
  }

  /** The map as it is shown. */
  svg(): string {
    const pen = new SvgPen(this.width, this.height);
    pen.within({ left: 0, top: 0, width: this.width, height: this.height }, 1, () => {
      if (this.legend.shown.space) this.drawSpace(pen);
      if (this.legend.shown.grid) drawGridLines(pen, this.screen());
      this.drawPoints(new SvgPoints(pen, this.width, this.height, this.placement(1)), 1);
      this.drawLines(pen);
    });
    return pen.file(shownIn("Map", this.store), themeColour("paper"));
  }

  /** Points replace what is drawn: what lies below them is drawn later, the uppermost first. */
  private drawBelow(context: CanvasRenderingContext2D): void {
    context.save();
    context.globalCompositeOperation = "destination-over";
    if (this.legend.shown.grid) drawGridLines(context, this.screen());
    if (this.legend.shown.space) this.drawSpace(context);
    context.restore();
  }

  private drawSpace(pen: CanvasRenderingContext2D | SvgPen): void {
    const picture = this.spacePicture();
    if (!picture) return;
    const unknown = (): void => {
      pen.fillStyle = themeColour("unknown");
      pen.fillRect(0, 0, this.width, this.height);
    };
    const matrix = picture.matrix(this.screen());
    if (pen instanceof SvgPen) {
      unknown();
      pen.picture(picture.canvas, matrix);
      return;
    }
    pen.save();
    pen.transform(...matrix);
    // The side of a pixel, whichever way the grid is turned.
    pen.imageSmoothingEnabled = Math.hypot(matrix[0], matrix[1]) < 1;
    pen.drawImage(picture.canvas, 0, 0);
    pen.restore();
    unknown();
  }

  /** Null for a map of points only. */
  private spacePicture(): SpacePicture | null {
    const grid = this.store.map?.grid;
    const theme = document.documentElement.dataset.theme ?? "";
    if (!grid || grid.width * grid.height === 0) return null;
    if (this.space?.grid !== grid || this.space.theme !== theme) this.space = { grid, theme, picture: new SpacePicture(grid) };
    return this.space.picture;
  }

  private screen(): Screen {
    const { x, y, scale } = this.view;
    const { width, height } = this;
    return { x: (mx) => width / 2 + (mx - x) * scale, y: (my) => height / 2 - (my - y) * scale, scale, width, height };
  }

  private drawLines(pen: Pen): void {
    if (this.legend.shown.grid) drawGridNumbers(pen, this.screen());
    new StepDrawing(this.store, this.screen(), this.legend.shown, this.legend.colour).draw(pen);
    drawScale(pen, this.screen());
  }

  /** Where the map lies on a drawing with so many pixels for one of the page. */
  private placement(ratio: number): Placement {
    const { x, y, scale } = this.screen();
    return { u0: x(0) * ratio, v0: y(0) * ratio, scale: scale * ratio };
  }

  private contents(): Box | null {
    const { map, steps } = this.store;
    let box = map ? boundingBox(map.x, map.y, metres) : null;
    if (steps) {
      box = union(box, boundingBox(steps.reference.x, steps.reference.y));
      if (!map) box = union(box, boundingBox(steps.estimate.x, steps.estimate.y));
    }
    return box;
  }

  private toMap(px: number, py: number): { x: number; y: number } {
    return {
      x: this.view.x + (px - this.width / 2) / this.view.scale,
      y: this.view.y - (py - this.height / 2) / this.view.scale,
    };
  }

  /** Everything that is points: below all lines. */
  private drawPoints(layer: PointSink, ratio: number): void {
    const { map } = this.store;
    if (map && this.legend.shown.map) {
      const all = { x: map.x, y: map.y, begin: 0, end: map.x.length };
      layer.draw(all, { x: 0, y: 0, theta: 0 }, map.spacing_m, 1, themeColour("wall"));
    }
    const robot = chosenPose(this.store);
    if (robot) this.drawObserved(layer, robot, 2 * ratio);
  }

  /** The local map and the scan, laid on the map under a robot pose. */
  private drawObserved(layer: PointSink, robot: Pose, least: number): void {
    const { step } = this.store.selected;
    const { local_map: lives, scans, columns } = this.store.trial ?? {};
    const size = this.store.map?.spacing_m ?? 0;
    const inLocal = columns ? poseAt(columns.local_from_robot, step) : null;
    if (lives && inLocal && this.legend.shown.local_map) {
      const frame = frameAt(lives, step);
      const isShown = (i: number): boolean => lives.from[i] <= frame && frame < lives.to[i];
      const points = { x: lives.x, y: lives.y, begin: 0, end: lives.x.length, isShown };
      layer.draw(points, compose(robot, inverse(inLocal)), size, least, themeColour("local-map"));
    }
    if (scans && this.legend.shown.scan) {
      const frame = frameAt(scans, step);
      if (scans.steps[frame] !== step) return;
      const points = { x: scans.x, y: scans.y, begin: scans.first[frame], end: scans.first[frame + 1] };
      layer.draw(points, robot, size, 1.5 * least, themeColour("scan"));
      // What hits are is known for the estimate alone.
      const hits = this.store.selected.hypothesis === "estimate" ? (columns?.hits[step] ?? "") : "";
      for (const [kind, letter] of [["unmapped", "n"], ["beyond", "b"]] as const) {
        const isShown = (i: number): boolean => hits[i - points.begin] === letter;
        if (this.legend.shown[kind]) layer.draw({ ...points, isShown }, robot, size, 2 * least, themeColour(kind));
      }
    }
  }

  /** For those who cannot see the picture, and what is missing in it for those who can. */
  private tellState(): void {
    const { steps, selected } = this.store;
    const missing = [...whatIsMissing(this.store), ...missingOfStep(this.store, chosenPose(this.store) !== null)];
    if (steps && steps.step.length > 0) {
      const listed = steps.best.first[selected.step + 1] - steps.best.first[selected.step];
      const hidden = listed - clustersDrawn(steps, selected, this.view.scale).length;
      if (hidden > 0) missing.push(`${hidden} more clusters as you zoom in.`);
    }
    replace(this.note, missing.join(" "));
    this.canvas.setAttribute("aria-label", shownIn("Map", this.store));
  }

  /** One more button beside those that zoom. */
  addButton(label: string, text: string, work: () => void): void {
    this.element.querySelector(".zoom")?.append(iconButton(label, text, work));
  }

  private centre(): void {
    const pose = chosenPose(this.store);
    if (this.follows && pose) Object.assign(this.view, { x: pose.x, y: pose.y });
  }

  private resize(): void {
    this.width = this.canvas.clientWidth;
    this.height = this.canvas.clientHeight;
    if (this.width === 0) return;
    this.canvas.width = Math.round(this.width * window.devicePixelRatio);
    this.canvas.height = Math.round(this.height * window.devicePixelRatio);
    if (!this.isMoved) this.fit();
    this.drawNow();
  }

  private listen(): void {
    const { canvas } = this;
    canvas.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        this.zoom(Math.exp(-event.deltaY / 400), { x: event.offsetX, y: event.offsetY });
      },
      { passive: false },
    );
    canvas.addEventListener("dblclick", () => this.fit());
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, event);
      this.moved = 0;
    });
    canvas.addEventListener("pointermove", (event) => this.pointerMoved(event));
    const released = (event: PointerEvent): void => {
      this.pointers.delete(event.pointerId);
    };
    canvas.addEventListener("pointercancel", released);
    canvas.addEventListener("pointerup", (event) => {
      released(event);
      if (this.moved < 4) this.clicked(event.offsetX, event.offsetY);
    });
    canvas.addEventListener("pointerleave", () => {
      this.tip.hidden = true;
      replace(this.cursor);
    });
  }

  /** Chooses the cluster there, and lists those near it. */
  private clicked(px: number, py: number): void {
    const cluster = this.clusterAt(px, py);
    if (cluster !== null) this.store.chooseHypothesis(cluster);
    const { steps } = this.store;
    if (!steps || steps.step.length === 0 || !this.legend.shown.clusters) return;
    this.near.show(steps, this.toMap(px, py), Math.max(nearby, reach / this.view.scale));
  }

  /** One pointer drags, two zoom and drag. */
  private pointerMoved(event: PointerEvent): void {
    const { x, y } = this.toMap(event.offsetX, event.offsetY);
    replace(this.cursor, `x ${fixed(x, 2)} m, y ${fixed(y, 2)} m`);
    const before = this.pointers.get(event.pointerId);
    if (!before) {
      this.showTip(event.offsetX, event.offsetY);
      return;
    }
    const right = event.offsetX - before.offsetX;
    const down = event.offsetY - before.offsetY;
    this.moved += Math.abs(right) + Math.abs(down);
    const other = [...this.pointers.values()].find((pointer) => pointer.pointerId !== event.pointerId);
    this.pan(right / this.pointers.size, down / this.pointers.size);
    if (other) {
      const distance = (pointer: PointerEvent): number =>
        Math.hypot(pointer.offsetX - other.offsetX, pointer.offsetY - other.offsetY);
      this.zoom(distance(event) / Math.max(distance(before), 1), { x: other.offsetX, y: other.offsetY });
    }
    this.pointers.set(event.pointerId, event);
  }

  /** Rank of the cluster under the pointer, the best if there are several; null if there is none. */
  private clusterAt(px: number, py: number): number | null {
    const steps = this.store.steps;
    const { step } = this.store.selected;
    if (!steps || steps.step.length === 0 || !this.legend.shown.clusters) return null;
    const { first, x, y } = steps.best;
    const screen = this.screen();
    let nearest: number | null = null;
    let least = reach;
    for (const k of clustersDrawn(steps, this.store.selected, this.view.scale).reverse()) {
      const distance = Math.hypot(screen.x(x[k]) - px, screen.y(y[k]) - py);
      if (distance < least - 0.5) {
        nearest = k - first[step];
        least = distance;
      }
    }
    return nearest;
  }

  private showTip(px: number, py: number): void {
    const rank = this.clusterAt(px, py);
    const steps = this.store.steps;
    this.canvas.classList.toggle("over-cluster", rank !== null);
    this.tip.hidden = rank === null;
    if (rank === null || !steps) return;
    const { best } = steps;
    const k = best.first[this.store.selected.step] + rank;
    replace(
      this.tip,
      el("strong", {}, `r̄ = ${significant(best.r_normalised[k])}`),
      ` · r = ${significant(best.r[k])}`,
      el("br"),
      `cluster ${rank + 1}, ${best.size[k]} ${best.size[k] === 1 ? "hypothesis" : "hypotheses"}`,
      el("br"),
      `${fixed(best.x[k], 2)} m, ${fixed(best.y[k], 2)} m, ${fixed(degrees(best.theta[k]), 1)}°`,
    );
    const left = Math.min(px + 14, this.width - this.tip.offsetWidth - 4);
    const top = py + 14 + this.tip.offsetHeight > this.height ? py - this.tip.offsetHeight - 8 : py + 14;
    this.tip.style.transform = `translate(${Math.max(0, left)}px, ${Math.max(0, top)}px)`;
  }
}

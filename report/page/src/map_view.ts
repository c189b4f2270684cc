// The map with everything that happened on it: the only drawing that is our own.
import { opacityOf, thinnedOut } from "./candidates_shown";
import { errorColour, errorRange, ratingColour, themeColour, verdictColours, verdictNames } from "./colours";
import { poseAt, type GlobalMap, type Grid, type PointLives, type Pose, type Scans, type Steps, type VerdictKind } from "./data";
import { el, replace } from "./elements";
import { fansOf } from "./field_of_view";
import { boundingBox, compose, degrees, inverse, union, type Box } from "./geometry";
import { saveMenu } from "./export";
import { drawGridLines, drawGridNumbers, SpacePicture, type Screen } from "./map_background";
import { NearPlaces } from "./near_places";
import { fixed, significant } from "./numbers";
import { SvgPen, type Pen } from "./pen";
import { PointLayer, SvgPoints, type Placement, type PointSink } from "./point_layer";
import type { Store } from "./store";
import { explained, meaningOf } from "./words";
import { iconButton, zoomButtons } from "./zoom_buttons";

const metres = 1e-3; // of the whole mm in which points are given
const triangle = { length: 15, width: 10 }; // px
const reach = 14; // px, of the pointer

const layers = {
  space: "free, unknown",
  grid: "grid",
  map: "global map",
  local_map: "local map",
  scan: "scan",
  view: "field of view",
  clusters: "clusters",
  candidates: "candidates",
  estimate: "estimate",
  reference: "reference",
  ends: "start, end",
  unknown_place: "unknown place",
} as const;
type Layer = keyof typeof layers;

/** What the dots of the estimate tell by their colour. */
const trajectoryColours = { plain: "one colour", verdict: "verdict", error: "error" } as const;
type TrajectoryColour = keyof typeof trajectoryColours;

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

/** Robot pose in the map that the local map is laid under; null without any. */
function chosenPose(store: Store): Pose | null {
  const steps = store.steps;
  const { step, hypothesis } = store.selected;
  if (!steps || steps.step.length === 0) return null;
  if (hypothesis === "reference") return poseAt(steps.reference, step);
  if (hypothesis === "estimate") return poseAt(steps.estimate, step);
  const { best } = steps;
  const k = best.first[step] + hypothesis;
  return k < best.first[step + 1] ? { x: best.x[k], y: best.y[k], theta: best.theta[k] } : null;
}

/** Null where a step has no colour of its own. */
function estimateColour(by: TrajectoryColour, steps: Steps, i: number): string | null {
  if (by === "verdict") return verdictColours[steps.verdict[i]];
  const error = steps.translation_error_m[i];
  return by === "error" && error != null ? errorColour(error) : null;
}

/** The newest frame recorded up to this step; -1 if there is none. */
export function frameAt(lives: PointLives | Scans, step: number): number {
  let frame = -1;
  while (frame + 1 < lives.steps.length && lives.steps[frame + 1] <= step) ++frame;
  return frame;
}

export class MapView {
  readonly element: HTMLElement;
  private readonly canvas = el("canvas", { tabindex: 0, role: "img" });
  private readonly tip = el("div", { class: "tip", hidden: true });
  private readonly note = el("p", { class: "note" });
  private readonly cursor = el("output", { class: "cursor", "aria-hidden": "true" });
  private readonly near: NearPlaces;
  private readonly colourBy = el("select", { "aria-label": "Colour of the estimate" });
  private readonly errorScale = el("span", { class: "scale" });
  private space: { grid: Grid; theme: string; picture: SpacePicture } | null = null;
  private readonly shown: Record<Layer, boolean>;
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
  private readonly boxes = new Map<Layer, HTMLInputElement>();
  private frame = 0;

  constructor(private readonly store: Store) {
    this.shown = Object.fromEntries(Object.keys(layers).map((layer) => [layer, true])) as Record<Layer, boolean>;
    this.near = new NearPlaces(store);
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
    this.element = el("figure", { class: "map" }, stage, this.legend());
    this.listen();
    store.subscribe((change) => {
      // Runs on one map are easier to compare if the view stays.
      if (change.run && this.globalMap() !== this.fittedMap && !store.report.live) this.fit();
      if (change.step) this.hideTip();
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

  /** What a link to this view says of it. */
  state(): Record<string, string> {
    const { x, y, scale } = this.view;
    const hidden = (Object.keys(layers) as Layer[]).filter((layer) => !this.shown[layer]);
    return {
      ...(this.isMoved ? { x: x.toFixed(3), y: y.toFixed(3), zoom: scale.toPrecision(4) } : {}),
      ...(hidden.length > 0 ? { hide: hidden.join(",") } : {}),
      ...(this.colourBy.value === "plain" ? {} : { colour: this.colourBy.value }),
    };
  }

  setState(said: URLSearchParams): void {
    const hidden = (said.get("hide") ?? "").split(",");
    for (const [layer, box] of this.boxes) this.shown[layer] = box.checked = !hidden.includes(layer);
    const colour = said.get("colour") ?? "";
    this.colourBy.value = colour in trajectoryColours ? colour : "plain";
    this.showErrorScale();
    const [x, y, zoom] = ["x", "y", "zoom"].map((name) => Number.parseFloat(said.get(name) ?? ""));
    if (Number.isFinite(x) && Number.isFinite(y) && zoom > 0) {
      this.view = { x, y, scale: withinLimits(zoom) };
      this.fittedMap = this.globalMap();
      this.isFitted = this.isMoved = true;
      this.draw();
    } else {
      this.fit();
    }
  }

  private hasMoved(): void {
    this.isMoved = true;
    this.tellView();
    this.draw();
  }

  private tellView(): void {
    this.element.dispatchEvent(new Event("viewchange"));
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
    this.fittedMap = this.globalMap();
    this.view = {
      x: (box.low.x + box.high.x) / 2,
      y: (box.low.y + box.high.y) / 2,
      scale: Math.max(Math.min((this.width - 2 * margin) / width, (this.height - 2 * margin) / height), 0.5),
    };
    if (wasMoved) this.tellView();
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
      if (this.shown.space) this.drawSpace(pen);
      if (this.shown.grid) drawGridLines(pen, this.screen());
      this.drawPoints(new SvgPoints(pen, this.width, this.height, this.placement(1)), 1);
      this.drawLines(pen);
    });
    return pen.file(this.description(), themeColour("paper"));
  }

  /** Points replace what is drawn: what lies below them is drawn later, the uppermost first. */
  private drawBelow(context: CanvasRenderingContext2D): void {
    context.save();
    context.globalCompositeOperation = "destination-over";
    if (this.shown.grid) drawGridLines(context, this.screen());
    if (this.shown.space) this.drawSpace(context);
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
    pen.imageSmoothingEnabled = matrix[3] < 1 && matrix[0] < 1;
    pen.drawImage(picture.canvas, 0, 0);
    pen.restore();
    unknown();
  }

  /** Null for a map of points only. */
  private spacePicture(): SpacePicture | null {
    const grid = this.globalMap()?.grid;
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
    if (this.shown.grid) drawGridNumbers(pen, this.screen());
    const steps = this.store.steps;
    if (steps && steps.step.length > 0) this.drawStep(pen, steps);
    this.drawScale(pen);
  }

  /** Where the map lies on a drawing with so many pixels for one of the page. */
  private placement(ratio: number): Placement {
    const origin = this.toScreen(0, 0);
    return { u0: origin.x * ratio, v0: origin.y * ratio, scale: this.view.scale * ratio };
  }

  private globalMap(): GlobalMap | undefined {
    const { run, report } = this.store;
    return run.map === undefined ? undefined : report.maps[run.map];
  }

  private contents(): Box | null {
    const map = this.globalMap();
    const steps = this.store.steps;
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

  private toScreen(x: number, y: number): { x: number; y: number } {
    return {
      x: this.width / 2 + (x - this.view.x) * this.view.scale,
      y: this.height / 2 - (y - this.view.y) * this.view.scale,
    };
  }

  /** Everything that is points: below all lines. */
  private drawPoints(layer: PointSink, ratio: number): void {
    const map = this.globalMap();
    if (map && this.shown.map) {
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
    const size = this.globalMap()?.spacing_m ?? 0;
    const inLocal = columns ? poseAt(columns.local_from_robot, step) : null;
    if (lives && inLocal && this.shown.local_map) {
      const frame = frameAt(lives, step);
      const isShown = (i: number): boolean => lives.from[i] <= frame && frame < lives.to[i];
      const points = { x: lives.x, y: lives.y, begin: 0, end: lives.x.length, isShown };
      layer.draw(points, compose(robot, inverse(inLocal)), size, least, themeColour("local-map"));
    }
    if (scans && this.shown.scan) {
      const frame = frameAt(scans, step);
      if (scans.steps[frame] !== step) return;
      const points = { x: scans.x, y: scans.y, begin: scans.first[frame], end: scans.first[frame + 1] };
      layer.draw(points, robot, size, 1.5 * least, themeColour("scan"));
    }
  }

  private drawStep(context: Pen, steps: Steps): void {
    const { step } = this.store.selected;
    if (this.shown.view) this.drawFieldOfView(context);
    if (this.shown.reference) this.drawReference(context, steps);
    if (this.shown.estimate) this.drawEstimates(context, steps, step);
    if (this.shown.unknown_place) this.drawUnknownPlaces(context, steps, step);
    if (this.shown.ends) this.drawEnds(context, steps);
    if (this.shown.clusters) this.drawClusters(context, steps, step);
    if (this.shown.candidates) this.drawCandidates(context, steps, step);
    const reference = poseAt(steps.reference, step);
    if (reference && this.shown.reference) this.drawRobot(context, reference, themeColour("reference"), true);
    const estimate = poseAt(steps.estimate, step);
    if (estimate && this.shown.estimate) this.drawRobot(context, estimate, themeColour("estimate"), false);
  }

  private drawReference(context: Pen, steps: Steps): void {
    context.strokeStyle = themeColour("reference");
    context.lineWidth = 1.5;
    context.setLineDash([6, 4]);
    context.beginPath();
    let joined = false;
    for (let i = 0; i < steps.step.length; ++i) {
      const pose = poseAt(steps.reference, i);
      if (pose) {
        const at = this.toScreen(pose.x, pose.y);
        if (joined) context.lineTo(at.x, at.y);
        else context.moveTo(at.x, at.y);
      }
      joined = pose !== null;
    }
    context.stroke();
    context.setLineDash([]);
  }

  /** Dots, joined between steps that both are localized: before that, estimates jump about. Later ones are faint. */
  private drawEstimates(context: Pen, steps: Steps, shown: number): void {
    const plain = themeColour("estimate");
    const by = this.colourBy.value as TrajectoryColour;
    const size = by === "plain" ? 3 : 5;
    context.lineWidth = size - 1;
    context.strokeStyle = context.fillStyle = plain;
    let before: { x: number; y: number } | null = null;
    for (let i = 0; i < steps.step.length; ++i) {
      context.globalAlpha = i <= shown ? 1 : 0.25;
      // Canvases take long to read a colour, and there may be thousands of dots.
      if (by !== "plain") context.strokeStyle = context.fillStyle = estimateColour(by, steps, i) ?? plain;
      const pose = poseAt(steps.estimate, i);
      const at = pose && this.toScreen(pose.x, pose.y);
      if (at) {
        context.fillRect(at.x - size / 2, at.y - size / 2, size, size);
        if (before && steps.verdict[i] === "localized") {
          context.beginPath();
          context.moveTo(before.x, before.y);
          context.lineTo(at.x, at.y);
          context.stroke();
        }
      }
      before = steps.verdict[i] === "localized" ? at : null;
    }
    context.globalAlpha = 1;
  }

  /** What the laser sees from the pose that the local map is laid under. */
  private drawFieldOfView(context: Pen): void {
    const robot = chosenPose(this.store);
    const { scans } = this.store.trial ?? {};
    const { step } = this.store.selected;
    const frame = scans ? frameAt(scans, step) : -1;
    if (!robot || !scans || frame < 0 || scans.steps[frame] !== step) return;
    const hits = [];
    for (let i = scans.first[frame]; i < scans.first[frame + 1]; ++i) hits.push({ x: scans.x[i] * metres, y: scans.y[i] * metres });
    context.fillStyle = themeColour("scan");
    context.globalAlpha = 0.12;
    for (const fan of fansOf(hits)) {
      context.beginPath();
      for (const corner of fan) {
        const place = compose(robot, { ...corner, theta: 0 });
        const at = this.toScreen(place.x, place.y);
        context.lineTo(at.x, at.y);
      }
      context.closePath();
      context.fill();
    }
    context.globalAlpha = 1;
  }

  /** Boxes where the trial begins and ends: by the reference, or else by the estimates. */
  private drawEnds(context: Pen, steps: Steps): void {
    const of = steps.reference.x.some((x) => x != null) ? steps.reference : steps.estimate;
    const known = of.x.map((x, i) => (x == null ? -1 : i)).filter((i) => i >= 0);
    if (known.length === 0) return;
    const box = (i: number, name: string, isBelow: boolean): void => {
      const at = this.toScreen(of.x[i] as number, of.y[i] as number);
      const side = 12;
      context.strokeStyle = context.fillStyle = themeColour("ink");
      context.lineWidth = 1.5;
      context.beginPath();
      context.rect(at.x - side / 2, at.y - side / 2, side, side);
      context.stroke();
      context.font = "bold 11px system-ui, sans-serif";
      context.textAlign = "start";
      context.fillText(name, at.x + side / 2 + 4, isBelow ? at.y + 14 : at.y - 6);
    };
    box(known[0], "start", false);
    if (known.length > 1) box(known[known.length - 1], "end", true);
  }

  /** Crosses where the robot was, as far as that is known. */
  private drawUnknownPlaces(context: Pen, steps: Steps, shown: number): void {
    context.strokeStyle = verdictColours.unknown_place;
    context.lineWidth = 2;
    for (let i = 0; i < steps.step.length; ++i) {
      const pose = steps.verdict[i] === "unknown_place" ? (poseAt(steps.reference, i) ?? poseAt(steps.estimate, i)) : null;
      if (!pose) continue;
      context.globalAlpha = i <= shown ? 1 : 0.25;
      const { x, y } = this.toScreen(pose.x, pose.y);
      context.beginPath();
      context.moveTo(x - 4, y - 4);
      context.lineTo(x + 4, y + 4);
      context.moveTo(x - 4, y + 4);
      context.lineTo(x + 4, y - 4);
      context.stroke();
    }
    context.globalAlpha = 1;
  }

  /** Lowest rating first, so that the best end on top; the chosen one is always drawn. */
  private clustersDrawn({ best }: Steps, step: number): number[] {
    const [begin, end] = [best.first[step], best.first[step + 1]];
    const drawn = thinnedOut(best, begin, end, this.view.scale);
    const { hypothesis } = this.store.selected;
    const chosen = typeof hypothesis === "number" ? begin + hypothesis : end;
    return chosen < end && !drawn.includes(chosen) ? [...drawn, chosen] : drawn;
  }

  private drawClusters(context: Pen, steps: Steps, step: number): void {
    const { best } = steps;
    const chosen = this.store.selected.hypothesis;
    const begin = best.first[step];
    for (const k of this.clustersDrawn(steps, step)) {
      const isChosen = k - begin === chosen;
      context.globalAlpha = isChosen ? 1 : opacityOf(best.r[k], best.r[begin]);
      context.fillStyle = ratingColour(best.r[k]);
      context.strokeStyle = themeColour(isChosen ? "local-map" : "ink");
      context.lineWidth = isChosen ? 3 : 0.8;
      this.traceTriangle(context, best.x[k], best.y[k], best.theta[k], 1);
      context.fill();
      context.stroke();
    }
    context.globalAlpha = 1;
  }

  private drawCandidates(context: Pen, steps: Steps, step: number): void {
    context.strokeStyle = verdictColours.ambiguous;
    context.lineWidth = 2;
    const candidates = steps.candidates[step];
    for (let k = 0; k + 2 < candidates.length; k += 3) {
      const at = this.toScreen(candidates[k], candidates[k + 1]);
      context.beginPath();
      context.arc(at.x, at.y, triangle.length, 0, 2 * Math.PI);
      context.stroke();
    }
  }

  private drawRobot(context: Pen, pose: Pose, colour: string, dashed: boolean): void {
    context.strokeStyle = colour;
    context.lineWidth = 2.5;
    context.setLineDash(dashed ? [4, 3] : []);
    this.traceTriangle(context, pose.x, pose.y, pose.theta, 1.5);
    context.stroke();
    context.setLineDash([]);
  }

  /** Points where the robot looks. */
  private traceTriangle(context: Pen, x: number, y: number, theta: number, size: number): void {
    const at = this.toScreen(x, y);
    const c = Math.cos(theta) * size;
    const s = Math.sin(theta) * size;
    const corner = (along: number, across: number): [number, number] => [
      at.x + c * along - s * across,
      at.y - s * along - c * across,
    ];
    const { length, width } = triangle;
    context.beginPath();
    context.moveTo(...corner((2 * length) / 3, 0));
    context.lineTo(...corner(-length / 3, width / 2));
    context.lineTo(...corner(-length / 3, -width / 2));
    context.closePath();
  }

  private drawScale(context: Pen): void {
    const longest = 120 / this.view.scale;
    const power = 10 ** Math.floor(Math.log10(longest));
    const length = [5, 2, 1].map((n) => n * power).find((l) => l <= longest) ?? power;
    const width = length * this.view.scale;
    const y = this.height - 12;
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

  /** For those who cannot see the picture, and what is missing in it for those who can. */
  private tellState(): void {
    const { steps, trial } = this.store;
    const { step, hypothesis } = this.store.selected;
    const missing: string[] = [];
    if (!this.globalMap()) missing.push("The results hold no global map (output.maps: none).");
    if (!trial) missing.push("No trial was finished.");
    else if (!steps) missing.push("The results hold no steps (output.steps: false).");
    if (steps && steps.step.length > 0) {
      const listed = steps.best.first[step + 1] - steps.best.first[step];
      if (listed < steps.clusters[step]) missing.push(`The ${listed} best of ${steps.clusters[step]} clusters.`);
      const hidden = listed - this.clustersDrawn(steps, step).length;
      if (hidden > 0) missing.push(`${hidden} more as you zoom in.`);
      if (!chosenPose(this.store)) {
        missing.push(
          hypothesis === "estimate"
            ? "No hypothesis in this step: nothing to lay the local map under."
            : "This step has no such pose: nothing to lay the local map under.",
        );
      }
      const lives = trial?.local_map;
      const frame = lives ? frameAt(lives, step) : -1;
      if (this.store.report.live && frame < 0) missing.push("While the run goes on, only the newest step has its local map.");
      else if (!lives) missing.push("Local maps of this trial were not recorded (output.maps: all records every trial's).");
      else if (frame >= 0 && lives.steps[frame] !== step) missing.push(`The local map is that of step ${lives.steps[frame]}.`);
    }
    replace(this.note, missing.join(" "));
    this.canvas.setAttribute("aria-label", this.description());
  }

  private description(): string {
    const { steps, trial, selected } = this.store;
    const { step } = selected;
    if (!steps) return "Map";
    return `Map at step ${step} of trial ${trial?.trial}: ${steps.verdict[step] ?? "no step"}, ${steps.clusters[step] ?? 0} clusters`;
  }

  private legend(): HTMLElement {
    const entry = (layer: Layer): HTMLElement => {
      const box = el("input", {
        type: "checkbox",
        checked: true,
        "data-layer": layer,
        change: () => {
          this.shown[layer] = box.checked;
          this.tellView();
          this.draw();
        },
      });
      this.boxes.set(layer, box);
      const label = el("label", {}, box, el("span", { class: `symbol ${layer}`, "aria-hidden": "true" }), layers[layer]);
      // Without a mark of its own: the box has the focus.
      const meaning = meaningOf(layers[layer]) ?? meaningOf(layer);
      if (meaning !== undefined) label.dataset.meaning = meaning;
      return label;
    };
    const stops = [0, 0.25, 0.5, 0.75, 1].map(ratingColour).join(", ");
    const bar = el("span", { class: "bar", style: `background: linear-gradient(to right, ${stops})` });
    const follow = el("input", {
      type: "checkbox",
      change: () => {
        this.follows = follow.checked;
        this.centre();
        this.draw();
      },
    });
    for (const [value, text] of Object.entries(trajectoryColours)) this.colourBy.append(el("option", { value }, text));
    this.colourBy.addEventListener("change", () => {
      this.showErrorScale();
      this.tellView();
      this.draw();
    });
    const { least, most } = errorRange;
    const errorStops = [0, 0.25, 0.5, 0.75, 1].map((share) => errorColour(least * (most / least) ** share)).join(", ");
    const errorBar = el("span", { class: "bar", style: `background: linear-gradient(to right, ${errorStops})` });
    replace(this.errorScale, `error  ${least} m `, errorBar, ` ${most} m`);
    this.showErrorScale();
    const verdictLegend = (): HTMLElement =>
      el(
        "span",
        { class: "verdicts" },
        explained(el("span", {}, "strip of verdicts"), "verdict"),
        ...(Object.keys(verdictNames) as VerdictKind[]).map((kind) =>
          el("span", {}, el("i", { class: "swatch", style: `background: ${verdictColours[kind]}` }), verdictNames[kind]),
        ),
      );
    return el(
      "figcaption",
      { class: "legend" },
      ...(Object.keys(layers) as Layer[]).map(entry),
      el("span", { class: "scale" }, explained(el("span", {}, "rating r"), "r"), "  0 ", bar, " 1"),
      verdictLegend(),
      el("label", {}, "estimate by ", this.colourBy),
      el("label", {}, follow, "follow the robot"),
      this.errorScale,
    );
  }

  private showErrorScale(): void {
    this.errorScale.hidden = this.colourBy.value !== "error";
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
      this.hideTip();
      replace(this.cursor);
    });
  }

  /** Chooses the cluster there, and lists those near it. */
  private clicked(px: number, py: number): void {
    const cluster = this.clusterAt(px, py);
    if (cluster !== null) this.store.chooseHypothesis(cluster);
    const { steps } = this.store;
    if (!steps || steps.step.length === 0 || !this.shown.clusters) return;
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
    if (!steps || steps.step.length === 0 || !this.shown.clusters) return null;
    const { first, x, y } = steps.best;
    let nearest: number | null = null;
    let least = reach;
    for (const k of this.clustersDrawn(steps, step).reverse()) {
      const at = this.toScreen(x[k], y[k]);
      const distance = Math.hypot(at.x - px, at.y - py);
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
    if (rank === null || !steps) {
      this.hideTip();
      return;
    }
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
    this.tip.hidden = false;
    const left = Math.min(px + 14, this.width - this.tip.offsetWidth - 4);
    const top = py + 14 + this.tip.offsetHeight > this.height ? py - this.tip.offsetHeight - 8 : py + 14;
    this.tip.style.transform = `translate(${Math.max(0, left)}px, ${Math.max(0, top)}px)`;
  }

  private hideTip(): void {
    this.tip.hidden = true;
  }
}

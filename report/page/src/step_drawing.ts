// A step's poses on the map, and the ways that lead to them.
import { opacityOf, thinnedOut } from "./candidates_shown";
import { errorColour, ratingColour, themeColour, verdictColours } from "./colours";
import { frameAt, metres, poseAt, type MapChange, type Pose, type Steps } from "./data";
import { fansOf } from "./field_of_view";
import { compose } from "./geometry";
import type { Screen } from "./map_background";
import type { Layer, TrajectoryColour } from "./map_legend";
import { drawSegment, type Pen } from "./pen";
import type { Selection, Store } from "./store";

const triangle = { length: 15, width: 10 }; // px

/** Robot pose in the map that the local map is laid under; null without any. */
export function chosenPose(store: Store): Pose | null {
  const steps = store.steps;
  const { step, hypothesis } = store.selected;
  if (!steps || steps.step.length === 0) return null;
  if (hypothesis === "reference") return poseAt(steps.reference, step);
  if (hypothesis === "estimate") return poseAt(steps.estimate, step);
  const { best } = steps;
  const k = best.first[step] + hypothesis;
  return k < best.first[step + 1] ? { x: best.x[k], y: best.y[k], theta: best.theta[k] } : null;
}

/** Lowest rating first, so that the best end on top; the chosen one is always drawn. */
export function clustersDrawn({ best }: Steps, { step, hypothesis }: Selection, scale: number): number[] {
  const [begin, end] = [best.first[step], best.first[step + 1]];
  const drawn = thinnedOut(best, begin, end, scale);
  const chosen = typeof hypothesis === "number" ? begin + hypothesis : end;
  return chosen < end && !drawn.includes(chosen) ? [...drawn, chosen] : drawn;
}

/** Null where a step has no colour of its own. */
function estimateColour(by: TrajectoryColour, steps: Steps, i: number): string | null {
  if (by === "verdict") return verdictColours[steps.verdict[i]];
  const error = steps.translation_error_m[i];
  return by === "error" && error != null ? errorColour(error) : null;
}

export class StepDrawing {
  constructor(
    private readonly store: Store,
    private readonly screen: Screen,
    private readonly shown: Record<Layer, boolean>,
    private readonly colour: TrajectoryColour,
  ) {}

  draw(context: Pen): void {
    const { steps } = this.store;
    const { step } = this.store.selected;
    if (!steps || steps.step.length === 0) return;
    if (this.shown.view) this.drawFieldOfView(context);
    const { changes } = this.store.trial ?? {};
    if (changes && this.shown.unmapped) this.drawChanges(context, changes.new, themeColour("unmapped"));
    if (changes && this.shown.beyond) this.drawChanges(context, changes.gone, themeColour("beyond"));
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

  /** Boxes around what the trial has found to differ from the map. */
  private drawChanges(context: Pen, changes: MapChange[], colour: string): void {
    const { scale } = this.screen;
    context.strokeStyle = colour;
    context.lineWidth = 2;
    for (const { x, y, width, height } of changes) {
      const corner = this.at(x - width / 2, y + height / 2);
      context.beginPath();
      context.rect(corner.x, corner.y, width * scale, height * scale);
      context.stroke();
    }
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
        const at = this.at(pose.x, pose.y);
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
    const by = this.colour;
    const size = by === "plain" ? 3 : 5;
    context.lineWidth = size - 1;
    context.strokeStyle = context.fillStyle = plain;
    let before: { x: number; y: number } | null = null;
    for (let i = 0; i < steps.step.length; ++i) {
      context.globalAlpha = i <= shown ? 1 : 0.25;
      // Canvases take long to read a colour, and there may be thousands of dots.
      if (by !== "plain") context.strokeStyle = context.fillStyle = estimateColour(by, steps, i) ?? plain;
      const pose = poseAt(steps.estimate, i);
      const at = pose && this.at(pose.x, pose.y);
      if (at) {
        context.fillRect(at.x - size / 2, at.y - size / 2, size, size);
        if (before && steps.verdict[i] === "localized") drawSegment(context, before.x, before.y, at.x, at.y);
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
        const at = this.at(place.x, place.y);
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
      const at = this.at(of.x[i] as number, of.y[i] as number);
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
      const { x, y } = this.at(pose.x, pose.y);
      context.beginPath();
      context.moveTo(x - 4, y - 4);
      context.lineTo(x + 4, y + 4);
      context.moveTo(x - 4, y + 4);
      context.lineTo(x + 4, y - 4);
      context.stroke();
    }
    context.globalAlpha = 1;
  }

  private drawClusters(context: Pen, steps: Steps, step: number): void {
    const { best } = steps;
    const chosen = this.store.selected.hypothesis;
    const begin = best.first[step];
    for (const k of clustersDrawn(steps, this.store.selected, this.screen.scale)) {
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
      const at = this.at(candidates[k], candidates[k + 1]);
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
    const at = this.at(x, y);
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

  private at(x: number, y: number): { x: number; y: number } {
    return { x: this.screen.x(x), y: this.screen.y(y) };
  }
}

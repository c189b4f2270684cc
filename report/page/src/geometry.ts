// Poses in the plane.
import type { Pose } from "./data";

/** a_from_c of a_from_b and b_from_c. */
export function compose(a: Pose, b: Pose): Pose {
  const c = Math.cos(a.theta);
  const s = Math.sin(a.theta);
  return { x: a.x + c * b.x - s * b.y, y: a.y + s * b.x + c * b.y, theta: wrap(a.theta + b.theta) };
}

export function inverse(pose: Pose): Pose {
  const c = Math.cos(pose.theta);
  const s = Math.sin(pose.theta);
  return { x: -c * pose.x - s * pose.y, y: s * pose.x - c * pose.y, theta: wrap(-pose.theta) };
}

/** In (-pi, pi]. */
export function wrap(angle: number): number {
  const turn = 2 * Math.PI;
  const rest = angle - turn * Math.floor(angle / turn);
  return rest > Math.PI ? rest - turn : rest;
}

export function degrees(angle: number): number {
  return (angle * 180) / Math.PI;
}

export interface Box {
  low: { x: number; y: number };
  high: { x: number; y: number };
}

/** Null for no points. */
export function boundingBox(xs: ArrayLike<number | null>, ys: ArrayLike<number | null>, unit = 1): Box | null {
  const box = { low: { x: Infinity, y: Infinity }, high: { x: -Infinity, y: -Infinity } };
  for (let i = 0; i < xs.length; ++i) {
    const x = xs[i];
    const y = ys[i];
    if (x == null || y == null) continue;
    box.low.x = Math.min(box.low.x, x * unit);
    box.low.y = Math.min(box.low.y, y * unit);
    box.high.x = Math.max(box.high.x, x * unit);
    box.high.y = Math.max(box.high.y, y * unit);
  }
  return box.low.x > box.high.x ? null : box;
}

/** Null if both are. */
export function union(a: Box | null, b: Box | null): Box | null {
  if (!a || !b) return a ?? b;
  return {
    low: { x: Math.min(a.low.x, b.low.x), y: Math.min(a.low.y, b.low.y) },
    high: { x: Math.max(a.high.x, b.high.x), y: Math.max(a.high.y, b.high.y) },
  };
}

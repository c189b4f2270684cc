// Poses in space, as the columns of steps have them.
import type { Column, SpaceColumns, Steps } from "./data";

export interface SpacePose {
  /** x, y, z, m. */
  position: [number, number, number];
  /** x, y, z, w of a unit quaternion. */
  rotation: [number, number, number, number];
}

type Columns = SpaceColumns & Record<"x" | "y", Column>;

/** Null where row i has none. */
export function columnPose(columns: Columns, i: number): SpacePose | null {
  const { x, y, z, qx, qy, qz, qw } = columns;
  return poseOf([x, y, z, qx, qy, qz, qw].map((column) => column?.[i]));
}

/** The k-th of a step. */
export function candidatePose(steps: Steps, step: number, k: number): SpacePose | null {
  const [x, y] = steps.candidates[step].slice(3 * k);
  return poseOf([x, y, ...(steps.candidates_in_space?.[step].slice(5 * k, 5 * k + 5) ?? [])]);
}

/** Of x, y, z, qx, qy, qz, qw. */
function poseOf(values: (number | null | undefined)[]): SpacePose | null {
  const [x, y, z, qx, qy, qz, qw] = values;
  if (x == null || y == null || z == null || qx == null || qy == null || qz == null || qw == null) return null;
  return { position: [x, y, z], rotation: [qx, qy, qz, qw] };
}

// What the laser saw of the room in one scan: the fan from the robot to the hits.

const widestGap = (10 * Math.PI) / 180; // between rays; a wider one is not seen

interface Point {
  x: number;
  y: number;
}

/**
 * Corners of fans, each from the robot (0, 0) along its hits, in the robot's frame. Of hits in nearly the same direction the
 * nearest one ends the view.
 */
export function fansOf(hits: Point[], rays = 720): Point[][] {
  const nearest = new Map<number, Point>();
  for (const hit of hits) {
    const ray = Math.floor(((Math.atan2(hit.y, hit.x) + Math.PI) / (2 * Math.PI)) * rays) % rays;
    const before = nearest.get(ray);
    if (!before || Math.hypot(hit.x, hit.y) < Math.hypot(before.x, before.y)) nearest.set(ray, hit);
  }
  const order = [...nearest.keys()].sort((a, b) => a - b);
  if (order.length === 0) return [];
  const most = (widestGap / (2 * Math.PI)) * rays;
  const gapAfter = (i: number): number => (i + 1 < order.length ? order[i + 1] : order[0] + rays) - order[i];
  const ends = order.map((_, i) => i).filter((i) => gapAfter(i) > most);
  const at = (i: number): Point => nearest.get(order[i % order.length]) as Point;
  // Seen all around: one outline, without the robot as a corner.
  if (ends.length === 0) return [order.map((_, i) => at(i))];
  return ends.map((end, k) => {
    const begin = (k === 0 ? ends[ends.length - 1] - order.length : ends[k - 1]) + 1;
    const corners = Array.from({ length: end - begin + 1 }, (_, i) => at(begin + i + order.length));
    return [{ x: 0, y: 0 }, ...corners];
  });
}

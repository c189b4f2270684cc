// What is drawn of many places in space. Each is made once and given other places: a shader that nothing uses any more is thrown away, and
// translating it again takes longer than drawing.
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  LineBasicMaterial,
  LineDashedMaterial,
  LineSegments,
  Points,
  PointsMaterial,
  type Matrix4,
  type Plane,
  type Vector3,
} from "three";
import { metres } from "./data";

const leastPoint = 1.6; // px

/** In whole mm. */
export interface Coordinates {
  x: number[];
  y: number[];
  z: number[];
}

/** x, y, z of each of these points one after the other, m, less an origin. */
export function placesOf({ x, y, z }: Coordinates, chosen: number[], origin: Pick<Vector3, "x" | "y" | "z"> = { x: 0, y: 0, z: 0 }): Float32Array {
  const places = new Float32Array(3 * chosen.length);
  chosen.forEach((i, k) => {
    places[3 * k] = x[i] * metres - origin.x;
    places[3 * k + 1] = y[i] * metres - origin.y;
    places[3 * k + 2] = z[i] * metres - origin.z;
  });
  return places;
}

function give(object: { geometry: BufferGeometry }, places: Float32Array): BufferGeometry {
  object.geometry.dispose();
  object.geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(places, 3));
  return object.geometry;
}

/** Squares that face the reader. */
export class PointCloud {
  readonly object: Points<BufferGeometry, PointsMaterial>;
  private side = 0; // m

  /** What lies beyond `clip` is hidden. */
  constructor(clip: Plane) {
    const material = new PointsMaterial({ clippingPlanes: [clip] });
    // Far points would be smaller than a pixel and flicker.
    material.onBeforeCompile = (shader) => {
      const least = (leastPoint * window.devicePixelRatio).toFixed(2);
      shader.vertexShader = shader.vertexShader.replace(
        "#include <fog_vertex>",
        `gl_PointSize = max(gl_PointSize, ${least});\n#include <fog_vertex>`,
      );
    };
    this.object = new Points(new BufferGeometry(), material);
    this.object.matrixAutoUpdate = false;
    this.clear();
  }

  clear(): void {
    this.object.visible = false;
  }

  /** Places in a frame that lies in the scene at `sceneFromFrame`; one colour, or three numbers for each place. */
  show(places: Float32Array, sceneFromFrame: Matrix4, side: number, colour: string | Float32Array): void {
    const { object } = this;
    const geometry = give(object, places);
    if (typeof colour === "string") object.material.color.set(colour);
    else geometry.setAttribute("color", new BufferAttribute(colour, 3));
    object.material.vertexColors = typeof colour !== "string";
    object.matrix.copy(sceneFromFrame);
    object.matrixWorldNeedsUpdate = true;
    object.visible = true;
    this.side = side;
  }

  /** As large as a camera shows them. */
  seen(pointScale: number): void {
    this.object.material.size = this.side * pointScale;
  }
}

/** Lines from the first place to the second, from the third to the fourth and so on, over everything else. */
export class Way {
  readonly object: LineSegments<BufferGeometry, LineBasicMaterial | LineDashedMaterial>;

  constructor(isDashed: boolean) {
    const material = isDashed ? new LineDashedMaterial({ depthTest: false }) : new LineBasicMaterial({ depthTest: false });
    this.object = new LineSegments(new BufferGeometry(), material);
    this.object.renderOrder = 1;
  }

  /** Dashes suit a map of this length, m. */
  show(places: number[], colour: string, length: number): void {
    const { object } = this;
    give(object, new Float32Array(places));
    object.material.color = new Color(colour);
    if (!(object.material instanceof LineDashedMaterial)) return;
    Object.assign(object.material, { dashSize: length / 80, gapSize: length / 110 });
    object.computeLineDistances();
  }
}

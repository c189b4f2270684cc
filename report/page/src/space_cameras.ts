// From where a map in space is seen: from anywhere around it, or from above.
import { OrthographicCamera, PerspectiveCamera, Vector3, type Camera } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

export type CameraName = "orbit" | "above";

const fieldOfView = 45; // degrees
/** Half of what is seen at a distance of 1. */
const halfSeen = Math.tan((fieldOfView * Math.PI) / 360);

/** Places are those of the scene, m. */
export class Cameras {
  private readonly orbit = new PerspectiveCamera(fieldOfView, 1, 0.05, 5000);
  private readonly above = new OrthographicCamera(-1, 1, 1, -1, 0.1, 20000);
  private readonly controls: Record<CameraName, OrbitControls>;
  private chosen: CameraName = "orbit";
  /** By the reader: it no longer shows everything. */
  private readonly isMoved = { orbit: false, above: false };
  private height = 0; // px

  /** Dragging on the canvas and the wheel over it move them, of which `changed` is told. */
  constructor(canvas: HTMLCanvasElement, private readonly changed: () => void) {
    this.orbit.up.set(0, 0, 1);
    this.controls = { orbit: new OrbitControls(this.orbit, canvas), above: new OrbitControls(this.above, canvas) };
    this.controls.above.enableRotate = false;
    for (const [name, controls] of Object.entries(this.controls) as [CameraName, OrbitControls][]) {
      controls.enableDamping = false;
      controls.screenSpacePanning = true;
      controls.zoomToCursor = true;
      controls.addEventListener("change", () => {
        this.isMoved[name] = true;
        changed();
      });
    }
    // A left drag moves what is seen from above, as it does the plan.
    this.controls.above.mouseButtons.LEFT = this.controls.orbit.mouseButtons.RIGHT;
    this.controls.above.touches.ONE = 1;
  }

  get camera(): Camera {
    return this[this.chosen];
  }
  /** What is in the middle. */
  get target(): Vector3 {
    return this.controls[this.chosen].target;
  }
  /** What sizes of points in m are multiplied by. */
  get pointScale(): number {
    return this.chosen === "above" ? this.above.zoom : 1 / halfSeen;
  }

  choose(name: CameraName): void {
    this.chosen = name;
    for (const [each, controls] of Object.entries(this.controls)) controls.enabled = each === name;
  }

  metresPerPixel(place: Vector3): number {
    if (this.chosen === "above") return 1 / this.above.zoom;
    return (2 * place.distanceTo(this.orbit.position) * halfSeen) / this.height;
  }

  /** To so many px. */
  resize(width: number, height: number): void {
    this.height = height;
    this.orbit.aspect = width / height;
    this.orbit.updateProjectionMatrix();
    Object.assign(this.above, { left: -width / 2, right: width / 2, top: height / 2, bottom: -height / 2 });
    this.above.updateProjectionMatrix();
  }

  zoom(factor: number): void {
    if (this.chosen === "above") {
      this.above.zoom *= factor;
      this.above.updateProjectionMatrix();
    } else {
      this.orbit.position.sub(this.target).divideScalar(factor).add(this.target);
    }
    this.hasMoved();
  }

  /** By px to the right and down. */
  pan(right: number, down: number): void {
    const perPixel = this.metresPerPixel(this.target);
    const move = new Vector3(-right * perPixel, down * perPixel, 0).applyQuaternion(this.camera.quaternion);
    this.camera.position.add(move);
    this.target.add(move);
    this.hasMoved();
  }

  /** Shows a box around the origin, which reaches so far from it. */
  fit(half: Vector3): void {
    const { orbit, above } = this.controls;
    orbit.target.set(0, 0, 0);
    // From the side on which the map is long.
    const from = half.x >= half.y ? new Vector3(-0.2, -0.75, 0.75) : new Vector3(0.75, -0.2, 0.75);
    const corners = [-1, 1].flatMap((x) => [-1, 1].flatMap((y) => [-1, 1].map((z) => new Vector3(x, y, z).multiply(half))));
    let far = 4 * half.length();
    for (let i = 0; i < 6; ++i) {
      this.orbit.position.copy(from.normalize()).multiplyScalar(far);
      this.orbit.lookAt(0, 0, 0);
      this.orbit.near = far / 1000;
      this.orbit.far = 20 * far;
      this.orbit.updateProjectionMatrix();
      this.orbit.updateMatrixWorld();
      const places = corners.map((corner) => corner.clone().project(this.orbit));
      far *= Math.max(...places.map((at) => Math.max(Math.abs(at.x), Math.abs(at.y)))) / 0.92;
    }
    above.target.set(0, 0, 0);
    this.above.position.set(0, 0, 5000);
    this.above.zoom = Math.min(this.above.right / half.x, this.above.top / half.y) / 1.05;
    this.above.updateProjectionMatrix();
    orbit.update();
    above.update();
    this.isMoved.orbit = this.isMoved.above = false;
  }

  /**
   * Where the chosen one is and what is in its middle, m in a frame whose `origin` is the scene's; of that from above x and y of its
   * middle, and px per m. Null where it shows everything.
   */
  state(origin: Vector3): number[] | null {
    if (!this.isMoved[this.chosen]) return null;
    const middle = this.target.clone().add(origin);
    if (this.chosen === "above") return [middle.x, middle.y, this.above.zoom];
    return [...this.orbit.position.clone().add(origin).toArray(), ...middle.toArray()];
  }

  /** The same back again; false if these are not its numbers. */
  setState(numbers: number[], origin: Vector3): boolean {
    const isAbove = this.chosen === "above";
    if (numbers.length !== (isAbove ? 3 : 6) || !numbers.every(Number.isFinite)) return false;
    if (isAbove) {
      const [x, y, zoom] = numbers;
      if (zoom <= 0) return false;
      this.target.set(x - origin.x, y - origin.y, 0);
      this.above.position.set(this.target.x, this.target.y, 5000);
      this.above.zoom = zoom;
      this.above.updateProjectionMatrix();
    } else {
      this.orbit.position.fromArray(numbers).sub(origin);
      this.target.fromArray(numbers, 3).sub(origin);
    }
    this.hasMoved();
    return true;
  }

  private hasMoved(): void {
    this.controls[this.chosen].update();
    this.isMoved[this.chosen] = true;
    // Controls tell of what they do themselves only.
    this.changed();
  }
}

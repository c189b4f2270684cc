// Maps in space, drawn with WebGL: a script of its own, which only pages of runs in space carry.
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  ConeGeometry,
  CylinderGeometry,
  DoubleSide,
  Group,
  Line,
  LineBasicMaterial,
  LineDashedMaterial,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  OrthographicCamera,
  PerspectiveCamera,
  Plane,
  Points,
  PointsMaterial,
  Quaternion,
  Scene,
  TorusGeometry,
  Vector3,
  WebGLRenderer,
  type Object3D,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { ratingColour, themeColour, verdictColours } from "./colours";
import type { GlobalMap, Steps } from "./data";
import { el, replace } from "./elements";
import { degrees } from "./geometry";
import { frameAt } from "./map_view";
import { fixed, significant } from "./numbers";
import { candidatePose, clusterPose, columnPose, type SpacePose } from "./space_poses";
import type { Store } from "./store";
import { zoomButtons } from "./zoom_buttons";

const metres = 1e-3; // of the whole mm in which points are given
const fieldOfView = 45; // degrees
const arrowLength = 40; // px
const reach = 14; // px, of the pointer
const leastPoint = 1.6; // px

const layers = {
  map: "global map",
  local_map: "local map",
  scan: "scan",
  clusters: "clusters",
  candidates: "candidates",
  estimate: "estimate",
  reference: "reference",
} as const;
type Layer = keyof typeof layers;

/** An arrow along x and a pin along z, of length 1, so that tilt and roll can be seen. */
const shapes = {
  tip: new ConeGeometry(0.17, 0.4, 16).rotateZ(-Math.PI / 2).translate(0.8, 0, 0),
  shaft: new CylinderGeometry(0.055, 0.055, 0.6, 10).rotateZ(-Math.PI / 2).translate(0.3, 0, 0),
  /** Around arrow and cone, so that they are seen on points of any colour. */
  halo: new ConeGeometry(0.25, 0.56, 16).rotateZ(-Math.PI / 2).translate(0.79, 0, 0),
  sleeve: new CylinderGeometry(0.1, 0.1, 0.62, 10).rotateZ(-Math.PI / 2).translate(0.28, 0, 0),
  pin: new CylinderGeometry(0.035, 0.035, 0.45, 8).rotateX(Math.PI / 2).translate(0, 0, 0.225),
  cone: new ConeGeometry(0.16, 0.5, 12).rotateZ(-Math.PI / 2),
  edge: new ConeGeometry(0.22, 0.68, 12).rotateZ(-Math.PI / 2).translate(-0.01, 0, 0),
  ring: new TorusGeometry(0.55, 0.06, 8, 32),
};

/** Where nearly all values lie, m: a few stray points would make the rest small. */
function rangeOf(values: number[]): [number, number] {
  const sorted = Int32Array.from(values).sort();
  const at = (share: number): number => sorted[Math.round(share * (sorted.length - 1))] * metres;
  const [low, high] = [at(0.005), at(0.995)];
  return high > low ? [low, high] : [low - 0.5, low + 0.5];
}

const ceiling = { share: 0.15, from: 0.8, cut: 70 };

/** Whether so many points are near the top that they hide what is below. */
function hasCeiling(z: number[], [low, high]: [number, number]): boolean {
  const from = (low + ceiling.from * (high - low)) / metres;
  return z.filter((height) => height > from).length > ceiling.share * z.length;
}

/** Smooth edges take as long as all the rest where there is no graphics card to draw them. */
function isDrawnBySoftware(): boolean {
  const context = el("canvas").getContext("webgl2");
  const info = context?.getExtension("WEBGL_debug_renderer_info");
  const name = context && info ? String(context.getParameter(info.UNMASKED_RENDERER_WEBGL)) : "";
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

/** News of a run that goes on bring its map again and again, as another object. */
function isSame(a: GlobalMap | undefined, b: GlobalMap | undefined): boolean {
  if (!a || !b) return a === b;
  return a === b || (a.x.length === b.x.length && a.spacing_m === b.spacing_m && a.x.every((x, i) => x === b.x[i]));
}

export class SpaceView {
  readonly element: HTMLElement;
  private readonly canvas = el("canvas", { tabindex: 0, role: "img", "aria-label": "The map in space" });
  private readonly stage = el("div", { class: "stage" });
  private readonly tip = el("div", { class: "tip", hidden: true });
  private readonly note = el("p", { class: "note" });
  private readonly low = el("span", {});
  private readonly high = el("span", {});
  private readonly cut = el("input", { type: "range", min: 0, max: 100, value: 100, "aria-label": "Hide points above this height" });
  private readonly cutAt = el("output", {});
  private readonly bar = el("span", { class: "bar" });

  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly orbit = new PerspectiveCamera(fieldOfView, 1, 0.05, 5000);
  private readonly above = new OrthographicCamera(-1, 1, 1, -1, 0.1, 20000);
  private readonly controls: Record<"orbit" | "above", OrbitControls>;
  private readonly clip = new Plane(new Vector3(0, 0, -1), Infinity);
  /** What is drawn of each layer; coordinates less `centre`. */
  private readonly groups: Record<Layer, Group>;
  private readonly arrows: Object3D[] = [];
  private camera: "orbit" | "above" = "orbit";
  private map: GlobalMap | undefined;
  private centre = new Vector3();
  /** Half of the map's lengths, m. */
  private half = new Vector3(5, 5, 1);
  private heights: [number, number] = [0, 1];
  private frame = 0;
  private size = { width: 0, height: 0 };
  private isFitted = false;

  /** Throws an Error with a sentence for the reader where there is no WebGL. */
  constructor(private readonly store: Store) {
    const context = this.canvas.getContext("webgl2", { antialias: !isDrawnBySoftware(), preserveDrawingBuffer: true });
    if (!context) throw new Error("This browser draws nothing in space: WebGL is missing or switched off.");
    this.renderer = new WebGLRenderer({ canvas: this.canvas, context });
    this.renderer.setClearColor(0x000000, 0);
    this.renderer.localClippingEnabled = true;
    this.groups = Object.fromEntries(
      (Object.keys(layers) as Layer[]).map((layer) => [layer, new Group()]),
    ) as Record<Layer, Group>;
    this.scene.add(...Object.values(this.groups));
    this.orbit.up.set(0, 0, 1);
    this.controls = { orbit: new OrbitControls(this.orbit, this.canvas), above: new OrbitControls(this.above, this.canvas) };
    this.controls.above.enableRotate = false;
    for (const controls of Object.values(this.controls)) {
      controls.enableDamping = false;
      controls.screenSpacePanning = true;
      controls.zoomToCursor = true;
      controls.addEventListener("change", () => this.draw());
    }
    // A left drag moves what is seen from above, as it does the plan.
    this.controls.above.mouseButtons.LEFT = this.controls.orbit.mouseButtons.RIGHT;
    this.controls.above.touches.ONE = 1;
    this.cut.addEventListener("input", () => this.cutPoints());
    replace(this.stage, this.canvas, this.note, this.tip, zoomButtons(this));
    this.element = el("figure", { class: "map space" }, this.stage, this.legend());
    this.listen();
    this.rebuild();
    store.subscribe((change) => {
      if (change.run && !isSame(this.globalMap(), this.map)) this.rebuild();
      else this.showStep();
    });
    new ResizeObserver(() => this.resize()).observe(this.stage);
  }

  look(camera: "orbit" | "above"): void {
    this.camera = camera;
    for (const [name, controls] of Object.entries(this.controls)) controls.enabled = name === camera;
    this.canvas.dataset.camera = camera;
    this.draw();
  }

  zoom(factor: number): void {
    const { target } = this.controls[this.camera];
    if (this.camera === "above") {
      this.above.zoom *= factor;
      this.above.updateProjectionMatrix();
    } else {
      this.orbit.position.sub(target).divideScalar(factor).add(target);
    }
    this.controls[this.camera].update();
    this.draw();
  }

  /** By px to the right and down. */
  pan(right: number, down: number): void {
    const controls = this.controls[this.camera];
    const camera = controls.object;
    const perPixel = this.metresPerPixel(controls.target);
    const move = new Vector3(-right * perPixel, down * perPixel, 0).applyQuaternion(camera.quaternion);
    camera.position.add(move);
    controls.target.add(move);
    controls.update();
    this.draw();
  }

  /** Shows the whole map. */
  fit(): void {
    const { width, height } = this.size;
    if (width === 0) return;
    this.isFitted = true;
    const { orbit, above } = this.controls;
    orbit.target.set(0, 0, 0);
    // From the side on which the map is long.
    const { half } = this;
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
    this.above.zoom = Math.min(width / half.x, height / half.y) / 2.1;
    this.above.updateProjectionMatrix();
    orbit.update();
    above.update();
    this.draw();
  }

  /** In the next frame, once, however often it is asked for. */
  draw(): void {
    if (this.frame === 0) this.frame = requestAnimationFrame(() => this.drawNow());
  }

  drawNow(): void {
    this.frame = 0;
    if (this.size.width === 0 || !this.isFitted || this.element.hidden) return;
    const camera = this.camera === "orbit" ? this.orbit : this.above;
    camera.updateMatrixWorld();
    for (const arrow of this.arrows) arrow.scale.setScalar(arrowLength * this.metresPerPixel(arrow.position));
    const pixels = this.camera === "above" ? 1 / this.metresPerPixel(this.centre) : 1 / Math.tan((fieldOfView * Math.PI) / 360);
    for (const layer of ["map", "local_map", "scan"] as const) {
      for (const object of this.groups[layer].children) {
        const material = (object as Points<BufferGeometry, PointsMaterial>).material;
        material.sizeAttenuation = this.camera === "orbit";
        material.size = Number(object.userData.size) * pixels;
      }
    }
    this.renderer.render(this.scene, camera);
    // For whoever looks at the page from outside, as tests do; as the plan says it.
    const { target } = this.controls[this.camera];
    const [x, y] = [this.centre.x + target.x, this.centre.y + target.y];
    Object.assign(this.canvas.dataset, { x, y, scale: 1 / this.metresPerPixel(target), points: this.renderer.info.render.points });
  }

  /** The map, which may be another or in other colours, and all the rest. */
  rebuild(): void {
    const map = this.globalMap();
    const isOther = !isSame(map, this.map);
    this.map = map;
    if (isOther) this.placeMap();
    this.drawMap();
    this.showStep();
    if (isOther) this.fit();
  }

  private globalMap(): GlobalMap | undefined {
    const { map } = this.store.run;
    return map === undefined ? undefined : this.store.report.maps[map];
  }

  private placeMap(): void {
    const { map } = this;
    if (!map?.z || map.x.length === 0) return;
    const ranges = [map.x, map.y, map.z].map(rangeOf);
    this.heights = ranges[2];
    this.centre.fromArray(ranges.map(([low, high]) => (low + high) / 2));
    this.half.fromArray(ranges.map(([low, high]) => (high - low) / 2));
    this.cut.value = String(hasCeiling(map.z, this.heights) ? ceiling.cut : 100);
  }

  private drawMap(): void {
    const { map, heights } = this;
    this.clear("map");
    if (!map?.z) return;
    const colours = new Float32Array(3 * map.x.length);
    const scale = this.scaleOfHeights();
    map.z.forEach((z, i) => scale[Math.round(255 * this.shareOf(z * metres))].toArray(colours, 3 * i));
    const { x, y, z } = map;
    const points = this.points(x.length, (i) => [x[i] * metres, y[i] * metres, z[i] * metres], Math.max(map.spacing_m, 0.02));
    points.geometry.setAttribute("color", new BufferAttribute(colours, 3));
    points.material.vertexColors = true;
    points.material.clippingPlanes = [this.clip];
    this.groups.map.add(points);
    replace(this.low, `${fixed(heights[0], 1)} m `);
    replace(this.high, ` ${fixed(heights[1], 1)} m`);
    this.cutPoints();
  }

  private shareOf(z: number): number {
    const [low, high] = this.heights;
    return Math.min(Math.max((z - low) / (high - low), 0), 1);
  }

  /** From low to high; of viridis what is seen on this paper: its yellow fades on white, its violet on black. */
  private scaleOfHeights(): Color[] {
    const isDark = document.documentElement.dataset.theme === "dark";
    const [from, to] = isDark ? [0.22, 1] : [0, 0.86];
    const stops = Array.from({ length: 256 }, (_, i) => ratingColour(from + ((to - from) * i) / 255));
    this.bar.style.background = `linear-gradient(to right, ${[0, 64, 128, 192, 255].map((i) => stops[i]).join(", ")})`;
    return stops.map((stop) => new Color(stop));
  }

  private showStep(): void {
    const { steps } = this.store;
    for (const layer of Object.keys(layers) as Layer[]) if (layer !== "map") this.clear(layer);
    this.arrows.length = 0;
    this.tip.hidden = true;
    replace(this.note);
    if (steps && steps.step.length > 0) {
      const { step } = this.store.selected;
      this.showWays(steps);
      this.showPoses(steps, step);
      this.showObserved(steps, step);
      this.canvas.setAttribute(
        "aria-label",
        `The map in space at step ${step} of trial ${this.store.trial?.trial}: ${steps.verdict[step].replace("_", " ")}, ${steps.clusters[step]} clusters`,
      );
    }
    this.draw();
  }

  /** Robot pose in the map that the local map is laid under; null without any. */
  private chosenPose(steps: Steps, step: number): SpacePose | null {
    const { hypothesis } = this.store.selected;
    if (hypothesis === "reference") return columnPose(steps.reference, step);
    if (hypothesis === "estimate") return columnPose(steps.estimate, step);
    return clusterPose(steps, steps.best.first[step] + hypothesis);
  }

  /** Of estimate and reference. */
  private showWays(steps: Steps): void {
    for (const [layer, isDashed] of [["estimate", false], ["reference", true]] as const) {
      const places: number[] = [];
      for (let i = 0; i < steps.step.length; ++i) {
        const pose = columnPose(steps[layer], i);
        const isJoined = layer === "reference" || steps.verdict[i] === "localized";
        if (pose && isJoined) places.push(...this.placed(pose).toArray());
      }
      const geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(places), 3));
      const style = { color: new Color(themeColour(layer)), depthTest: false };
      const material = isDashed
        ? new LineDashedMaterial({ ...style, dashSize: this.half.length() / 80, gapSize: this.half.length() / 110 })
        : new LineBasicMaterial(style);
      const line = new Line(geometry, material);
      if (isDashed) line.computeLineDistances();
      line.renderOrder = 1;
      this.groups[layer].add(line);
    }
  }

  private showPoses(steps: Steps, step: number): void {
    const { hypothesis } = this.store.selected;
    const { first, r } = steps.best;
    for (let k = first[step + 1] - 1; k >= first[step]; --k) {
      const pose = clusterPose(steps, k);
      const isChosen = k - first[step] === hypothesis;
      if (!pose) continue;
      // The best on top.
      const order = 2 + (first[step + 1] - k) / 1e4;
      this.arrow("clusters", pose, ["edge"], themeColour(isChosen ? "local-map" : "paper"), order);
      this.arrow("clusters", pose, ["cone"], ratingColour(r[k]), order + 1e-5);
    }
    const candidates = steps.candidates[step].length / 3;
    for (let k = 0; k < candidates; ++k) {
      const pose = candidatePose(steps, step, k);
      if (pose) this.arrow("candidates", pose, ["ring"], verdictColours.ambiguous, 3);
    }
    for (const layer of ["reference", "estimate"] as const) {
      const pose = columnPose(steps[layer], step);
      if (!pose) continue;
      this.arrow(layer, pose, ["halo", "sleeve"], themeColour("paper"), 4);
      this.arrow(layer, pose, ["shaft", "tip", "pin"], themeColour(layer), 4.5);
    }
  }

  private arrow(layer: Layer, pose: SpacePose, parts: (keyof typeof shapes)[], colour: string, order: number): void {
    const arrow = new Group();
    const material = new MeshBasicMaterial({ color: new Color(colour), depthTest: false, side: DoubleSide });
    for (const part of parts) {
      const mesh = new Mesh(shapes[part], material);
      mesh.renderOrder = order;
      arrow.add(mesh);
    }
    arrow.position.copy(this.placed(pose));
    arrow.quaternion.set(...pose.rotation);
    this.groups[layer].add(arrow);
    this.arrows.push(arrow);
  }

  /** The local map and the scan, laid under the chosen pose. */
  private showObserved(steps: Steps, step: number): void {
    const robot = this.chosenPose(steps, step);
    const inLocal = columnPose(steps.local_from_robot, step);
    const { local_map: lives, scans } = this.store.trial ?? {};
    if (!lives) replace(this.note, "Local maps of this trial were not recorded (output.maps: all records every trial's).");
    if (!robot) {
      replace(this.note, "This step has no such pose: nothing to lay the local map under.");
      return;
    }
    const mapFromRobot = this.matrix(robot);
    const size = 1.8 * Math.max(this.map?.spacing_m ?? 0, 0.03);
    if (lives?.z && inLocal) {
      const frame = frameAt(lives, step);
      const chosen = lives.from.flatMap((from, i) => (from <= frame && frame < lives.to[i] ? [i] : []));
      const { x, y, z } = lives;
      const mapFromLocal = mapFromRobot.clone().multiply(this.matrix(inLocal).invert());
      this.observed("local_map", chosen.length, (i) => [x[chosen[i]], y[chosen[i]], z[chosen[i]]], mapFromLocal, size);
      if (frame >= 0 && lives.steps[frame] !== step) replace(this.note, `The local map is that of step ${lives.steps[frame]}.`);
    }
    const frame = scans ? frameAt(scans, step) : -1;
    if (scans?.z && frame >= 0 && scans.steps[frame] === step) {
      const { x, y, z, first } = scans;
      const begin = first[frame];
      this.observed("scan", first[frame + 1] - begin, (i) => [x[begin + i], y[begin + i], z[begin + i]], mapFromRobot, size);
    }
  }

  /** Points in whole mm of a frame of their own. */
  private observed(layer: "local_map" | "scan", count: number, at: (i: number) => number[], mapFromFrame: Matrix4, size: number): void {
    const place = new Vector3();
    const points = this.points(count, (i) => place.fromArray(at(i)).multiplyScalar(metres).applyMatrix4(mapFromFrame).toArray(), size);
    points.material.color.set(themeColour(layer === "scan" ? "scan" : "local-map"));
    points.material.clippingPlanes = [this.clip];
    this.groups[layer].add(points);
  }

  /** At places in the map, m. */
  private points(count: number, at: (i: number) => number[], size: number): Points<BufferGeometry, PointsMaterial> {
    const places = new Float32Array(3 * count);
    for (let i = 0; i < count; ++i) {
      const [x, y, z] = at(i);
      places[3 * i] = x - this.centre.x;
      places[3 * i + 1] = y - this.centre.y;
      places[3 * i + 2] = z - this.centre.z;
    }
    const geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(places, 3));
    const material = new PointsMaterial({ size });
    // Far points would be smaller than a pixel and flicker.
    material.onBeforeCompile = (shader) => {
      const least = (leastPoint * window.devicePixelRatio).toFixed(2);
      shader.vertexShader = shader.vertexShader.replace(
        "#include <fog_vertex>",
        `gl_PointSize = max(gl_PointSize, ${least});\n#include <fog_vertex>`,
      );
    };
    const points = new Points(geometry, material);
    points.userData.size = size;
    return points;
  }

  private placed(pose: SpacePose): Vector3 {
    return new Vector3(...pose.position).sub(this.centre);
  }

  private matrix(pose: SpacePose): Matrix4 {
    return new Matrix4().compose(new Vector3(...pose.position), new Quaternion(...pose.rotation), new Vector3(1, 1, 1));
  }

  private clear(layer: Layer): void {
    for (const object of this.groups[layer].children) {
      if (!(object instanceof Points || object instanceof Line)) continue;
      object.geometry.dispose();
      object.material.dispose();
    }
    this.groups[layer].clear();
  }

  /** At a place, less `centre`. */
  private metresPerPixel(place: Vector3): number {
    if (this.camera === "above") return 1 / this.above.zoom;
    const depth = place.distanceTo(this.orbit.position);
    return (2 * depth * Math.tan((fieldOfView * Math.PI) / 360)) / this.size.height;
  }

  private cutPoints(): void {
    const share = Number(this.cut.value) / 100;
    const [low, high] = this.heights;
    const at = low + share * (high - low);
    this.clip.constant = share < 1 ? at - this.centre.z : Infinity;
    replace(this.cutAt, share < 1 ? `up to ${fixed(at, 1)} m` : "all heights");
    this.draw();
  }

  private resize(): void {
    const width = this.stage.clientWidth;
    const height = this.stage.clientHeight;
    this.size = { width, height };
    if (width === 0) return;
    this.renderer.setPixelRatio(window.devicePixelRatio);
    this.renderer.setSize(width, height, false);
    this.orbit.aspect = width / height;
    this.orbit.updateProjectionMatrix();
    Object.assign(this.above, { left: -width / 2, right: width / 2, top: height / 2, bottom: -height / 2 });
    this.above.updateProjectionMatrix();
    if (!this.isFitted) this.fit();
    this.drawNow();
  }

  private legend(): HTMLElement {
    const entry = (layer: Layer): HTMLElement => {
      const box = el("input", {
        type: "checkbox",
        checked: true,
        "data-space-layer": layer,
        change: () => {
          this.groups[layer].visible = box.checked;
          this.draw();
        },
      });
      return el("label", {}, box, el("span", { class: `symbol ${layer}`, "aria-hidden": "true" }), layers[layer]);
    };
    return el(
      "figcaption",
      { class: "legend" },
      ...(Object.keys(layers) as Layer[]).map(entry),
      el("span", { class: "scale" }, "height ", this.low, this.bar, this.high),
      el("label", { class: "cut" }, "show ", this.cut, this.cutAt),
    );
  }

  private listen(): void {
    let down = { x: 0, y: 0 };
    this.canvas.addEventListener("pointerdown", (event) => (down = { x: event.offsetX, y: event.offsetY }));
    this.canvas.addEventListener("pointerup", (event) => {
      if (Math.hypot(event.offsetX - down.x, event.offsetY - down.y) > 4) return;
      const rank = this.clusterAt(event.offsetX, event.offsetY);
      if (rank !== null) this.store.chooseHypothesis(rank);
    });
    this.canvas.addEventListener("pointermove", (event) => event.buttons === 0 && this.showTip(event.offsetX, event.offsetY));
    this.canvas.addEventListener("pointerleave", () => (this.tip.hidden = true));
    this.canvas.addEventListener("dblclick", () => this.fit());
  }

  /** Rank of the cluster under the pointer; null if there is none. */
  private clusterAt(px: number, py: number): number | null {
    const { steps } = this.store;
    const { step } = this.store.selected;
    if (!steps || steps.step.length === 0 || !this.groups.clusters.visible) return null;
    const camera = this.camera === "orbit" ? this.orbit : this.above;
    let nearest: number | null = null;
    let least = reach;
    for (let k = steps.best.first[step]; k < steps.best.first[step + 1]; ++k) {
      const pose = clusterPose(steps, k);
      if (!pose) continue;
      const at = this.placed(pose).project(camera);
      const distance = Math.hypot(((at.x + 1) / 2) * this.size.width - px, ((1 - at.y) / 2) * this.size.height - py);
      if (at.z < 1 && distance < least - 0.5) {
        nearest = k - steps.best.first[step];
        least = distance;
      }
    }
    return nearest;
  }

  private showTip(px: number, py: number): void {
    const rank = this.clusterAt(px, py);
    const { steps } = this.store;
    this.canvas.classList.toggle("over-cluster", rank !== null);
    this.tip.hidden = rank === null;
    if (rank === null || !steps) return;
    const k = steps.best.first[this.store.selected.step] + rank;
    const { r, r_normalised: normalised, x, y, z, theta } = steps.best;
    replace(
      this.tip,
      el("strong", {}, `r̄ = ${significant(normalised[k])}`),
      ` · r = ${significant(r[k])}`,
      el("br"),
      `cluster ${rank + 1}: ${fixed(x[k], 2)} m, ${fixed(y[k], 2)} m, ${fixed(z?.[k], 2)} m, ${fixed(degrees(theta[k]), 1)}°`,
    );
    const left = Math.min(px + 14, this.size.width - this.tip.offsetWidth - 4);
    const top = py + 14 + this.tip.offsetHeight > this.size.height ? py - this.tip.offsetHeight - 8 : py + 14;
    this.tip.style.transform = `translate(${Math.max(0, left)}px, ${Math.max(0, top)}px)`;
  }
}

window.glocalSpace = { SpaceView };

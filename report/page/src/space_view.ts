// Maps in space, drawn with WebGL: a script of its own, which only pages of runs in space carry.
import { ColorManagement, Group, LinearSRGBColorSpace, Matrix4, Quaternion, Scene, Vector3, WebGLRenderer } from "three";
import { ratingColour, themeColour, verdictColours } from "./colours";
import { frameAt, type GlobalMap, type Steps } from "./data";
import { el, replace } from "./elements";
import { degrees } from "./geometry";
import { KeptDrawing } from "./kept_drawing";
import { layerBox } from "./layer_box";
import { missingOfStep, shownIn, whatIsMissing } from "./missing";
import { fixed, significant } from "./numbers";
import { Arrows } from "./space_arrows";
import { Cameras, type CameraName } from "./space_cameras";
import { Heights, rangeOf } from "./space_heights";
import { placesOf, PointCloud, Way, type Coordinates } from "./space_points";
import { candidatePose, columnPose, type SpacePose } from "./space_poses";
import type { Store } from "./store";
import { tellView, type Linked } from "./view_change";
import { zoomButtons } from "./zoom_buttons";

const reach = 14; // px, of the pointer

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
type CloudLayer = "map" | "local_map" | "scan";
type ArrowLayer = Exclude<Layer, CloudLayer>;

// Nothing here has light and shadow: colours are those of the style sheet, as they are.
ColorManagement.enabled = false;

/** Without a graphics card smooth edges take as long as all the rest, and points of a map longer. */
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

function matrixOf(place: Vector3, { rotation }: SpacePose): Matrix4 {
  return new Matrix4().compose(place, new Quaternion(...rotation), new Vector3(1, 1, 1));
}

function indices(begin: number, end: number): number[] {
  return Array.from({ length: end - begin }, (_, i) => begin + i);
}

export class SpaceView implements Linked {
  readonly element: HTMLElement;
  private readonly canvas = el("canvas", { tabindex: 0, role: "img" });
  private readonly stage = el("div", { class: "stage" });
  private readonly tip = el("div", { class: "tip", hidden: true });
  private readonly note = el("p", { class: "note" });

  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly cameras: Cameras;
  private readonly heights = new Heights(() => this.hasChanged());
  /** What is drawn of each layer; coordinates less `centre`. */
  private readonly groups: Record<Layer, Group>;
  private readonly clouds: Record<CloudLayer, PointCloud>;
  private readonly ways = { estimate: new Way(false), reference: new Way(true) };
  private readonly arrows: Record<ArrowLayer, Arrows>;
  /** The map as it was last drawn; null where it need not be kept. */
  private readonly kept: KeptDrawing | null;
  private readonly boxes = new Map<Layer, HTMLInputElement>();
  private map: GlobalMap | undefined;
  private centre = new Vector3();
  /** Half of the map's lengths, m. */
  private half = new Vector3(5, 5, 1);
  private frame = 0;
  private size = { width: 0, height: 0 };
  private isFitted = false;

  /** Throws an Error with a sentence for the reader where there is no WebGL. */
  constructor(private readonly store: Store) {
    const isSlow = isDrawnBySoftware();
    const context = this.canvas.getContext("webgl2", { antialias: !isSlow, preserveDrawingBuffer: true });
    if (!context) throw new Error("This browser draws nothing in space: WebGL is missing or switched off.");
    this.renderer = new WebGLRenderer({ canvas: this.canvas, context });
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.renderer.setClearColor(0x000000, 0);
    this.renderer.localClippingEnabled = true;
    this.cameras = new Cameras(this.canvas, () => this.hasChanged());
    const cloud = (): PointCloud => new PointCloud(this.heights.clip);
    this.clouds = { map: cloud(), local_map: cloud(), scan: cloud() };
    this.arrows = { clusters: new Arrows(), candidates: new Arrows(), estimate: new Arrows(), reference: new Arrows() };
    const parts = (layer: Layer): Group => {
      const objects = [this.clouds, this.ways, this.arrows].flatMap((all) => Object.entries(all).flatMap(([name, part]) => (name === layer ? [part.object] : [])));
      return new Group().add(...objects);
    };
    this.groups = Object.fromEntries((Object.keys(layers) as Layer[]).map((layer) => [layer, parts(layer)])) as Record<Layer, Group>;
    this.scene.add(...Object.values(this.groups));
    this.kept = isSlow ? new KeptDrawing(this.renderer) : null;
    if (this.kept) {
      this.kept.scene.add(this.groups.map);
      this.scene.add(this.kept.sheet);
    }
    replace(this.stage, this.canvas, this.note, this.tip, zoomButtons(this));
    this.element = el("figure", { class: "map space" }, this.stage, this.legend());
    this.listen();
    this.rebuild();
    store.subscribe((change) => {
      if (change.run && !isSame(this.store.map, this.map)) {
        this.rebuild();
        return;
      }
      if (change.trial) this.showWays();
      this.showStep();
    });
    new ResizeObserver(() => this.resize()).observe(this.stage);
  }

  look(camera: CameraName): void {
    this.cameras.choose(camera);
    this.canvas.dataset.camera = camera;
    this.hasChanged();
  }

  zoom(factor: number): void {
    this.cameras.zoom(factor);
  }

  /** By px to the right and down. */
  pan(right: number, down: number): void {
    this.cameras.pan(right, down);
  }

  /** Shows the whole map. */
  fit(): void {
    if (this.size.width === 0) return;
    this.isFitted = true;
    this.cameras.fit(this.half);
    this.hasChanged();
  }

  state(): Record<string, string> {
    const eye = this.cameras.state(this.centre);
    const hidden = [...this.boxes].filter(([, box]) => !box.checked).map(([layer]) => layer);
    const cut = this.heights.state();
    return {
      ...(eye ? { eye: eye.map((value) => value.toFixed(3)).join(",") } : {}),
      ...(hidden.length > 0 ? { hide_in_space: hidden.join(",") } : {}),
      ...(cut === null ? {} : { heights: cut }),
    };
  }

  setState(said: URLSearchParams): void {
    const hidden = (said.get("hide_in_space") ?? "").split(",");
    for (const [layer, box] of this.boxes) this.groups[layer].visible = box.checked = !hidden.includes(layer);
    this.heights.setState(said.get("heights"));
    // A page that was just opened has not been laid out: what the cameras see depends on that.
    this.resize();
    const eye = (said.get("eye") ?? "").split(",").map(Number.parseFloat);
    if (!this.cameras.setState(eye, this.centre)) this.fit();
  }

  /** The map, which may be another or in other colours, and all the rest. */
  rebuild(): void {
    const { map } = this.store;
    const isOther = !isSame(map, this.map);
    this.map = map;
    if (isOther) this.placeMap();
    this.showMap();
    this.showWays();
    this.showStep();
    if (isOther) this.fit();
    this.hasChanged();
  }

  /** More than what a step has of its own. */
  private hasChanged(): void {
    this.kept?.forget();
    this.draw();
    tellView(this.element);
  }

  /** In the next frame, once, however often it is asked for. */
  private draw(): void {
    if (this.frame === 0) this.frame = requestAnimationFrame(() => this.drawNow());
  }

  private drawNow(): void {
    this.frame = 0;
    if (this.size.width === 0 || !this.isFitted || this.element.hidden) return;
    const { cameras } = this;
    const { camera, target } = cameras;
    camera.updateMatrixWorld();
    for (const arrows of Object.values(this.arrows)) arrows.seen((place) => cameras.metresPerPixel(place));
    for (const cloud of Object.values(this.clouds)) cloud.seen(cameras.pointScale);
    this.kept?.draw(camera);
    this.renderer.render(this.scene, camera);
    // For whoever looks at the page from outside, as tests do; as the plan says it.
    const [x, y] = [this.centre.x + target.x, this.centre.y + target.y];
    Object.assign(this.canvas.dataset, { x, y, scale: 1 / cameras.metresPerPixel(target) });
  }

  private placeMap(): void {
    const { map } = this;
    if (!map?.z || map.x.length === 0) return;
    const ranges = [map.x, map.y, map.z].map(rangeOf);
    this.centre.fromArray(ranges.map(([low, high]) => (low + high) / 2));
    this.half.fromArray(ranges.map(([low, high]) => (high - low) / 2));
    this.heights.take(map.z, ranges[2]);
  }

  private showMap(): void {
    const { x, y, z, spacing_m } = this.map ?? {};
    this.clouds.map.clear();
    if (!x || !y || !z || spacing_m === undefined) return;
    const places = placesOf({ x, y, z }, indices(0, x.length), this.centre);
    this.clouds.map.show(places, new Matrix4(), Math.max(spacing_m, 0.02), this.heights.colours(z));
  }

  /** Of estimate and reference, from step to step as in the plan. */
  private showWays(): void {
    const { steps } = this.store;
    for (const layer of ["estimate", "reference"] as const) {
      const places: number[] = [];
      let before: number[] | null = null;
      for (let i = 0; i < (steps?.step.length ?? 0); ++i) {
        const pose = steps && columnPose(steps[layer], i);
        const isJoined = layer === "reference" || steps?.verdict[i] === "localized";
        const at: number[] | null = pose && isJoined ? this.placed(pose).toArray() : null;
        if (before && at) places.push(...before, ...at);
        before = at;
      }
      this.ways[layer].show(places, themeColour(layer), this.half.length());
    }
  }

  private showStep(): void {
    const { steps } = this.store;
    for (const arrows of Object.values(this.arrows)) arrows.clear();
    this.clouds.local_map.clear();
    this.clouds.scan.clear();
    this.tip.hidden = true;
    const { step } = this.store.selected;
    const robot = steps && steps.step.length > 0 ? this.chosenPose(steps, step) : null;
    replace(this.note, [...whatIsMissing(this.store), ...missingOfStep(this.store, robot !== null)].join(" "));
    if (steps && steps.step.length > 0) {
      this.showPoses(steps, step);
      if (robot) this.showObserved(steps, step, robot);
    }
    this.canvas.setAttribute("aria-label", shownIn("The map in space", this.store));
    this.draw();
  }

  /** Robot pose in the map that the local map is laid under; null without any. */
  private chosenPose(steps: Steps, step: number): SpacePose | null {
    const { hypothesis } = this.store.selected;
    if (hypothesis === "reference") return columnPose(steps.reference, step);
    if (hypothesis === "estimate") return columnPose(steps.estimate, step);
    const k = steps.best.first[step] + hypothesis;
    return k < steps.best.first[step + 1] ? columnPose(steps.best, k) : null;
  }

  private showPoses(steps: Steps, step: number): void {
    const { hypothesis } = this.store.selected;
    const { first, r } = steps.best;
    for (let k = first[step + 1] - 1; k >= first[step]; --k) {
      const pose = columnPose(steps.best, k);
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

  private arrow(layer: ArrowLayer, pose: SpacePose, parts: Parameters<Arrows["add"]>[2], colour: string, order: number): void {
    this.arrows[layer].add(this.placed(pose), pose.rotation, parts, colour, order);
  }

  /** The local map and the scan, laid under the chosen pose. */
  private showObserved(steps: Steps, step: number, robot: SpacePose): void {
    const inLocal = columnPose(steps.local_from_robot, step);
    const { local_map: lives, scans } = this.store.trial ?? {};
    const sceneFromRobot = matrixOf(this.placed(robot), robot);
    if (lives?.z && inLocal) {
      const frame = frameAt(lives, step);
      const chosen = lives.from.flatMap((from, i) => (from <= frame && frame < lives.to[i] ? [i] : []));
      const localFromRobot = matrixOf(new Vector3(...inLocal.position), inLocal);
      this.observed("local_map", { ...lives, z: lives.z }, chosen, sceneFromRobot.clone().multiply(localFromRobot.invert()));
    }
    const frame = scans ? frameAt(scans, step) : -1;
    if (scans?.z && frame >= 0 && scans.steps[frame] === step)
      this.observed("scan", { ...scans, z: scans.z }, indices(scans.first[frame], scans.first[frame + 1]), sceneFromRobot);
  }

  /** Points of a frame of their own. */
  private observed(layer: "local_map" | "scan", points: Coordinates, chosen: number[], sceneFromFrame: Matrix4): void {
    const side = 1.8 * Math.max(this.map?.spacing_m ?? 0, 0.03);
    this.clouds[layer].show(placesOf(points, chosen), sceneFromFrame, side, themeColour(layer === "scan" ? "scan" : "local-map"));
  }

  private placed(pose: SpacePose): Vector3 {
    return new Vector3(...pose.position).sub(this.centre);
  }

  private resize(): void {
    const width = this.stage.clientWidth;
    const height = this.stage.clientHeight;
    this.size = { width, height };
    if (width === 0) return;
    this.renderer.setPixelRatio(window.devicePixelRatio);
    this.renderer.setSize(width, height, false);
    this.cameras.resize(width, height);
    this.kept?.forget();
    if (!this.isFitted) this.fit();
    this.drawNow();
  }

  private legend(): HTMLElement {
    const entry = (layer: Layer): HTMLElement => {
      const { label, box } = layerBox(layer, layers[layer], "data-space-layer", (isShown) => {
        this.groups[layer].visible = isShown;
        this.hasChanged();
      });
      this.boxes.set(layer, box);
      return label;
    };
    return el(
      "figcaption",
      { class: "legend" },
      ...(Object.keys(layers) as Layer[]).map(entry),
      ...this.heights.legend,
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
    let nearest: number | null = null;
    let least = reach;
    for (let k = steps.best.first[step]; k < steps.best.first[step + 1]; ++k) {
      const pose = columnPose(steps.best, k);
      if (!pose) continue;
      const at = this.placed(pose).project(this.cameras.camera);
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

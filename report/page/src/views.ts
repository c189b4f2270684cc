// The place of the map: the plan, and for runs in space the same seen from anywhere.
import { isInSpace } from "./data";
import { el, replace } from "./elements";
import type { MapView } from "./map_view";
import type { SpaceView } from "./space_view";
import type { Store } from "./store";
import { tellView, type Linked } from "./view_change";

type View = "orbit" | "above" | "plan";

const names: Record<View, string> = { orbit: "in space", above: "from above", plan: "plan" };
/** Of runs in space. */
const opening: View = "orbit";

function isView(text: string): text is View {
  return text in names;
}

/** Pages of runs in space have a script that sets this. */
declare global {
  interface Window {
    glocalSpace?: { SpaceView: typeof SpaceView };
  }
}

export class Views implements Linked {
  readonly element: HTMLElement;
  private readonly space: SpaceView | null = null;
  private readonly buttons = new Map<View, HTMLElement>();
  private chosen: View = "plan";

  constructor(
    store: Store,
    private readonly plan: MapView,
  ) {
    this.element = plan.element;
    if (!window.glocalSpace || !isInSpace(store.report)) return;
    const bar = el("div", { class: "view-bar", role: "group", "aria-label": "View of the map" });
    try {
      this.space = new window.glocalSpace.SpaceView(store);
    } catch (error) {
      replace(bar, el("p", { class: "note" }, `${error instanceof Error ? error.message : error} The plan shows the run from above.`));
      this.element = el("div", { class: "views" }, bar, plan.element);
      return;
    }
    for (const view of Object.keys(names) as View[]) {
      const button = el("button", { type: "button", "data-view": view, click: () => this.chosenByReader(view) }, names[view]);
      this.buttons.set(view, button);
      bar.append(button);
    }
    this.element = el("div", { class: "views" }, bar, this.space.element, plan.element);
    this.choose(opening);
  }

  zoom(factor: number): void {
    this.shown.zoom(factor);
  }

  pan(right: number, down: number): void {
    this.shown.pan(right, down);
  }

  fit(): void {
    this.shown.fit();
  }

  state(): Record<string, string> {
    const { plan, space, chosen } = this;
    return { ...plan.state(), ...(space ? { ...(chosen === opening ? {} : { view: chosen }), ...space.state() } : {}) };
  }

  setState(said: URLSearchParams): void {
    this.plan.setState(said);
    if (!this.space) return;
    const view = said.get("view") ?? "";
    this.choose(isView(view) ? view : opening);
    this.space.setState(said);
  }

  /** Colours may be others. */
  drawNow(): void {
    this.plan.drawNow();
    this.space?.rebuild();
  }

  private get shown(): MapView | SpaceView {
    return this.chosen === "plan" || !this.space ? this.plan : this.space;
  }

  private chosenByReader(view: View): void {
    this.choose(view);
    tellView(this.element);
  }

  private choose(view: View): void {
    this.chosen = view;
    this.plan.element.hidden = view !== "plan";
    if (this.space) this.space.element.hidden = view === "plan";
    if (view !== "plan") this.space?.look(view);
    for (const [name, button] of this.buttons) button.setAttribute("aria-pressed", String(name === view));
  }
}

// Making parts of the page. Text of results only ever becomes text, never markup.
export type Child = Node | string | number | null | undefined | false;
type Attributes = Record<string, string | number | boolean | EventListener | undefined>;

/** An element; attributes that are functions listen to the event of that name. */
export function el<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") element.addEventListener(name, value);
    else if (value !== undefined && value !== false) element.setAttribute(name, value === true ? "" : String(value));
  }
  append(element, ...children);
  return element;
}

export function append(parent: Element, ...children: Child[]): void {
  for (const child of children) {
    if (child === null || child === undefined || child === false) continue;
    parent.append(child instanceof Node ? child : String(child));
  }
}

export function replace(parent: Element, ...children: Child[]): void {
  parent.replaceChildren();
  append(parent, ...children);
}

/** A part of the page with a heading that links can lead to. */
export function section(id: string, title: string, ...children: Child[]): HTMLElement {
  return el("section", { id, "aria-labelledby": `${id}-title` }, el("h2", { id: `${id}-title` }, title), ...children);
}

/** The colours of shares from 0 to 1, of which so many are told and the others lie in between. */
export function colourBar(colourOf: (share: number) => string, told = 5): HTMLElement {
  const colours = Array.from({ length: told }, (_, i) => colourOf(i / (told - 1)));
  return el("span", { class: "bar", style: `background: linear-gradient(to right, ${colours.join(", ")})` });
}

/** More sentences than these are read by few. */
const mostSentences = 8;

/** Sentences one below the other; many of them are folded, up to the first few. */
export function list(sentences: string[], className = ""): HTMLElement | null {
  if (sentences.length === 0) return null;
  const points = (some: string[]): HTMLElement => el("ul", { class: className }, ...some.map((text) => el("li", {}, text)));
  const rest = sentences.slice(mostSentences);
  if (rest.length < 2) return points(sentences);
  return el("div", {}, points(sentences.slice(0, mostSentences)), el("details", { class: "rest" }, el("summary", {}, `and ${rest.length} more`), points(rest)));
}

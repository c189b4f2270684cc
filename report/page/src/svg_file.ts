// An SVG drawing of the page as a file of its own: what the style sheet says of it becomes part of it.
import { themeColour } from "./colours";
import { svg } from "./svg";

const titleHeight = 24; // px
/** What children have, too, unless they say otherwise. */
const inherited = ["fill", "stroke", "stroke-width", "stroke-dasharray", "paint-order", "font-family", "font-size", "font-weight"];
const own = { opacity: "1", "vector-effect": "none" };

/** Few programs know the form that mixed colours have in browsers. */
function plainColour(text: string): string {
  const parts = /^color\(srgb ([\d.]+) ([\d.]+) ([\d.]+)\)$/.exec(text);
  return parts ? `rgb(${parts.slice(1).map((part) => Math.round(255 * Number(part))).join(", ")})` : text;
}

/** How a shape looks; `around` is how that looks which it is part of. */
function styleOf(look: CSSStyleDeclaration, around: CSSStyleDeclaration | null): string {
  const value = (name: string): string => look.getPropertyValue(name);
  const told = [
    ...inherited.filter((name) => value(name) !== around?.getPropertyValue(name)),
    ...Object.entries(own).flatMap(([name, usual]) => (value(name) === usual ? [] : [name])),
  ];
  return told.map((name) => `${name}: ${plainColour(value(name))}`).join("; ");
}

/** Of a shape and all within it; `shown` is on the page. */
function copyOf(shown: Element, around: CSSStyleDeclaration | null): Element {
  const copy = shown.cloneNode(false) as Element;
  for (const { name } of [...copy.attributes]) if (/^(class|style|role|tabindex|aria-.*|data-.*)$/.test(name)) copy.removeAttribute(name);
  const look = getComputedStyle(shown);
  const style = styleOf(look, around);
  if (style !== "" && shown.tagName !== "title") copy.setAttribute("style", style);
  for (const child of shown.childNodes) copy.append(child instanceof Element ? copyOf(child, look) : child.cloneNode());
  return copy;
}

/** Below its title; `behind` is a canvas of the same size that it lies on. */
export function svgFile(drawing: SVGSVGElement, title: string, behind?: HTMLCanvasElement): string {
  const { width, height } = drawing.viewBox.baseVal;
  const copy = copyOf(drawing, null);
  const heading = svg("text", { x: 8, y: 16, fill: themeColour("ink"), style: "font: bold 12px system-ui, sans-serif" }, title);
  const picture = behind ? [svg("image", { href: behind.toDataURL(), width, height })] : [];
  const file = svg(
    "svg",
    { width, height: height + titleHeight, viewBox: `0 0 ${width} ${height + titleHeight}` },
    svg("title", {}, title),
    svg("rect", { width: "100%", height: "100%", fill: themeColour("paper") }),
    heading,
    svg("g", { transform: `translate(0 ${titleHeight})`, style: copy.getAttribute("style") ?? "" }, ...picture, ...copy.childNodes),
  );
  return `${new XMLSerializer().serializeToString(file)}\n`;
}

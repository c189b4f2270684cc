// Parallel coordinates: each setting of a sweep as a line over its parameters to what came of it.
import { ratingColour } from "./colours";
import type { Sweep } from "./data";
import { el, replace } from "./elements";
import { saveMenu } from "./export";
import { percent } from "./numbers";
import { svg } from "./svg";
import { svgFile } from "./svg_file";

const height = 230; // px
const top = 26;
const bottom = height - 14;
const fewestSettings = 4;

/** A parameter, or the success: where a setting's value lies, 0 at the bottom to 1, and what the axis is labelled with. */
interface Axis {
  label: string;
  title: string;
  /** Null where the setting does not change the parameter. */
  place: (index: number) => number | null;
  marks: { at: number; text: string }[];
}

/** Null where lines would say no more than the table: for few settings, or a single parameter. */
export function parallelCoordinates(sweep: Sweep): HTMLElement | null {
  if (sweep.settings.length < fewestSettings || sweep.effects.length < 2) return null;
  const target = el("div", { class: "parallel-plot" });
  const axes = [...sweep.effects.map(({ path, label }) => parameterAxis(sweep, path, label)), successAxis(sweep)];
  const title = "Settings, a line for each, in the colour of their share of right trials; the best on top";
  let width = 0;
  let shown: SVGSVGElement | null = null;
  new ResizeObserver(() => {
    if (target.clientWidth === width || target.clientWidth === 0) return;
    width = target.clientWidth;
    shown = drawing(sweep, axes, width);
    replace(target, shown);
  }).observe(target);
  return el(
    "figure",
    { class: "parallel" },
    el("figcaption", {}, title, saveMenu(() => "parallel coordinates", () => (shown ? svgFile(shown, title) : ""))),
    el("div", { class: "scroll", tabindex: 0 }, target),
  );
}

function successAxis({ settings }: Sweep): Axis {
  const marks = [0, 0.25, 0.5, 0.75, 1].map((at) => ({ at, text: `${100 * at} %` }));
  return { label: "right", title: "Share of right trials", place: (i) => settings[i].chosen.success_rate.value, marks };
}

function parameterAxis({ settings }: Sweep, path: string, label: string): Axis {
  const values = settings.map((setting) => setting.values[path]);
  const known = values.filter((value) => value !== undefined);
  const numbers = known.map(Number);
  const isNumeric = numbers.every((value) => Number.isFinite(value)) && known.every((value) => value.trim() !== "");
  if (!isNumeric) {
    const kinds = [...new Set(known)].sort();
    const at = (value: string): number => (kinds.length > 1 ? kinds.indexOf(value) / (kinds.length - 1) : 0.5);
    return { label, title: path, place: (i) => (values[i] === undefined ? null : at(values[i])), marks: kinds.map((text) => ({ at: at(text), text })) };
  }
  const [low, high] = [Math.min(...numbers), Math.max(...numbers)];
  const isLog = low > 0 && high / low > 10;
  const scale = isLog ? Math.log : (value: number): number => value;
  const at = (value: number): number => (high > low ? (scale(value) - scale(low)) / (scale(high) - scale(low)) : 0.5);
  const few = [...new Set(numbers)];
  const shown = few.length <= 5 ? few : [low, high];
  return {
    label: isLog ? `${label} (log)` : label,
    title: path,
    place: (i) => (values[i] === undefined ? null : at(Number(values[i]))),
    marks: shown.map((value) => ({ at: at(value), text: String(Number(value.toPrecision(4))) })),
  };
}

function drawing({ settings, effects }: Sweep, axes: Axis[], width: number): SVGSVGElement {
  const [left, right] = [50, width - 60];
  const x = (k: number): number => left + ((right - left) * k) / (axes.length - 1);
  const y = (at: number): number => bottom - at * (bottom - top);
  const lines = settings.map((setting, i) => {
    const points = axes.flatMap((axis, k) => {
      const at = axis.place(i);
      return at === null ? [] : [`${x(k).toFixed(1)} ${y(at).toFixed(1)}`];
    });
    const { value } = setting.chosen.success_rate;
    const told = effects.map(({ path, label }) => `${label} ${setting.values[path] ?? "–"}`).join(", ");
    const line = svg("path", { d: `M${points.join("L")}`, "data-setting": setting.setting }, svg("title", {}, `${setting.setting}: ${percent(value)} right; ${told}`));
    // Neither viridis's violet nor its yellow is lost on any paper that way.
    line.style.stroke = `color-mix(in srgb, ${ratingColour(value)} 72%, var(--ink))`;
    return line;
  });
  return svg(
    "svg",
    { viewBox: `0 0 ${width} ${height}`, width, height, role: "img", "aria-label": `Settings by ${axes.map(({ label }) => label).join(", ")}; the table has the numbers` },
    // Settings are best first; what is drawn last is on top.
    svg("g", { class: "lines" }, ...lines.reverse()),
    ...axes.map((axis, k) =>
      svg(
        "g",
        { class: "axis" },
        svg("line", { x1: x(k), x2: x(k), y1: top, y2: bottom }),
        svg("text", { class: "label", x: x(k), y: 13, "text-anchor": "middle" }, svg("title", {}, axis.title), axis.label),
        ...axis.marks.map(({ at, text }) => svg("text", { x: x(k) + 5, y: y(at) + 4 }, text)),
      ),
    ),
  );
}

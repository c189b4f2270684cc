// Numbers as people read them.
import type { Proportion } from "./data";

const none = "–";

/** With so many significant digits, without exponent where it can be avoided. */
export function significant(value: number | null | undefined, digits = 3): string {
  if (value == null || !Number.isFinite(value)) return none;
  // Less than that is what rounding has left of nothing.
  if (Math.abs(value) < 1e-12) return "0";
  const magnitude = Math.floor(Math.log10(Math.abs(value)));
  if (magnitude < -4 || magnitude > 8) return value.toExponential(digits - 1);
  return value.toFixed(Math.max(0, digits - 1 - magnitude));
}

export function fixed(value: number | null | undefined, digits: number): string {
  return value == null || !Number.isFinite(value) ? none : value.toFixed(digits);
}

export function count(value: number | null | undefined): string {
  return value == null ? none : value.toLocaleString("en");
}

export function percent(value: number): string {
  return `${(100 * value).toFixed(1)} %`;
}

/** With its 95 % interval. */
export function proportion(p: Proportion): string {
  return `${percent(p.value)} (${(100 * p.low).toFixed(1)} to ${percent(p.high)})`;
}

export function duration(seconds: number): string {
  if (seconds < 90) return `${Math.ceil(seconds)} s`;
  if (seconds < 5400) return `${Math.round(seconds / 60)} min`;
  return `${(seconds / 3600).toFixed(1)} h`;
}

const units: Record<string, string> = { m: "m", deg: "°", ms: "ms" };
const spoken: Record<string, string> = { step_cpu: "CPU time of a step" };

/** The name of a number as results files have it, for people: "rotation_error_deg" is "rotation error, °". */
export function nameOf(key: string): string {
  const [, name, unit] = /^(.*)_(m|deg|ms)$/.exec(key) ?? [null, key, null];
  return (spoken[name] ?? name.replaceAll("_", " ")) + (unit ? `, ${units[unit]}` : "");
}

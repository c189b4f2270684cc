// Drawings as SVG: few shapes, each an element of its own.

export function svg<K extends keyof SVGElementTagNameMap>(
  tag: K,
  attributes: Record<string, string | number> = {},
  ...children: (Node | string)[]
): SVGElementTagNameMap[K] {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  element.append(...children);
  return element;
}

/** The least of 1, 2, 5, 10 … that is no less. */
export function roundStep(least: number): number {
  const power = 10 ** Math.floor(Math.log10(least));
  return [1, 2, 5, 10].map((n) => n * power).find((step) => step >= least * (1 - 1e-9)) ?? 10 * power;
}

/** Of a step, in [low, high]. */
export function multiples(step: number, low: number, high: number): number[] {
  const from = Math.ceil(low / step - 1e-9);
  const to = Math.floor(high / step + 1e-9);
  return Array.from({ length: Math.max(0, to - from + 1) }, (_, i) => Number(((from + i) * step).toPrecision(12)));
}

/** Round numbers in [low, high], about so many. */
export function ticks(low: number, high: number, about: number): number[] {
  return high > low ? multiples(roundStep((high - low) / Math.max(about, 1)), low, high) : [low];
}

/** Whether values from low to high are told apart better that way. What rounding has left of nothing would stretch it over many powers of ten. */
export function isLogarithmic(low: number, high: number): boolean {
  return low > 1e-6 * high && high / low > 30;
}

/** Powers of ten in [low, high], and their halves and fifths where there are few. */
export function logTicks(low: number, high: number): number[] {
  const powers: number[] = [];
  for (let k = Math.ceil(Math.log10(low) - 1e-9); k <= Math.log10(high) + 1e-9; ++k) powers.push(10 ** k);
  if (powers.length > 2) return powers;
  const all = [];
  for (let k = Math.floor(Math.log10(low)); k <= Math.log10(high); ++k) all.push(...[1, 2, 5].map((n) => n * 10 ** k));
  return all.filter((tick) => tick >= low * (1 - 1e-9) && tick <= high * (1 + 1e-9));
}

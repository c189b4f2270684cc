// What all charts share: how uPlot is set up to fit the page.
import uPlot from "uplot";
import { chartSvg } from "./chart_svg";
import { themeColour } from "./colours";
import { saveMenu } from "./export";
import { significant } from "./numbers";

export interface Line {
  label: string;
  colour: string;
  dash: number[];
  values: (number | null)[];
  width?: number;
  stepped?: boolean;
}

export interface ChartOptions {
  x: number[];
  lines: Line[];
  /** Of the axes: below, and on the left. */
  xLabel: string;
  label: string;
  logX?: boolean;
  logY?: boolean;
  /** Fixed ranges of both. */
  xRange?: [number, number];
  range?: [number, number];
  /** The x axis has ticks at whole numbers only. */
  whole?: boolean;
  height: number;
  /** Charts of the same key share their cursor. */
  sync?: string;
  hooks?: uPlot.Hooks.Arrays;
}

/** From one tick to the next. */
const wholeSteps = [1, 10, 100, 1000, 10000].flatMap((power) => [power, 2 * power, 5 * power]);

export const font = "11px system-ui, sans-serif";

function axis(label: string, more: Partial<uPlot.Axis>): uPlot.Axis {
  const ink = themeColour("ink");
  const grid = themeColour("grid");
  return {
    ...(label ? { label } : {}),
    font,
    labelFont: font,
    labelSize: 14,
    labelGap: 0,
    stroke: ink,
    grid: { stroke: grid, width: 1 },
    ticks: { stroke: grid, width: 1, size: 4 },
    ...more,
  };
}

/** Logarithms want positive numbers. */
function positive(values: (number | null)[]): (number | null)[] {
  return values.map((value) => (value !== null && value > 0 ? value : null));
}

const labelled = (_: uPlot, splits: (number | null)[]): string[] =>
  splits.map((value) => (value === null ? "" : significant(value, 3).replace(/(\.\d*?)0+$/, "$1").replace(/\.$/, "")));

/** Draws a chart into `target`, as wide as it is, until the returned function is called. */
export function chart(target: HTMLElement, options: ChartOptions): { plot: uPlot; destroy: () => void } {
  const { lines, logX, logY } = options;
  const distr = (isLog?: boolean): 1 | 3 => (isLog ? 3 : 1);
  const scales: uPlot.Scales = {
    x: { time: false, distr: distr(logX), ...(options.xRange ? { range: options.xRange } : {}) },
    y: { distr: distr(logY), ...(options.range && !logY ? { range: options.range } : {}) },
  };
  const axes = [
    axis(options.xLabel, { values: labelled, size: 26, space: 45, ...(options.whole ? { incrs: wholeSteps } : {}) }),
    axis(options.label, { values: labelled, size: 44, space: 24 }),
  ];
  const series: uPlot.Series[] = lines.map((line) => ({
    label: line.label,
    stroke: line.colour,
    dash: line.dash,
    width: line.width ?? 1.5,
    scale: "y",
    points: { show: options.x.length === 1 },
    ...(line.stepped ? { paths: uPlot.paths.stepped?.({ align: 1 }), spanGaps: true } : {}),
  }));
  const plot = new uPlot(
    {
      width: Math.max(target.clientWidth, 120),
      height: options.height,
      legend: { show: false },
      cursor: {
        y: false,
        points: { size: 6 },
        ...(options.sync ? { sync: { key: options.sync, scales: ["x", null] } } : {}),
      },
      scales,
      axes,
      series: [{}, ...series],
      hooks: options.hooks ?? {},
    },
    [options.x, ...lines.map((line) => (logY ? positive(line.values) : line.values))] as uPlot.AlignedData,
    target,
  );
  const observer = new ResizeObserver(() => {
    const width = target.clientWidth;
    if (width > 0 && width !== plot.width) plot.setSize({ width, height: options.height });
  });
  observer.observe(target);
  const title = (): string => target.closest(".panel")?.querySelector("h3")?.firstChild?.textContent ?? "plot";
  const menu = saveMenu(title, () => chartSvg(plot, options, title()));
  target.append(menu);
  const destroy = (): void => {
    menu.remove();
    observer.disconnect();
    plot.destroy();
  };
  return { plot, destroy };
}

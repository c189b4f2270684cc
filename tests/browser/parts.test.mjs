// The page's arithmetic, by hand.
import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { join } from "node:path";
import { before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { workFolder } from "./runs.mjs";

const page = process.env.GLOCAL_PAGE_FOLDER; // as it was built
let geometry, numbers, shares;

before(async () => {
  const { build } = createRequire(join(page, "package.json"))("esbuild");
  const folder = workFolder();
  const load = async (name) => {
    const outfile = join(folder, `${name}.mjs`);
    await build({ entryPoints: [join(page, "src", `${name}.ts`)], bundle: true, format: "esm", outfile, logLevel: "error" });
    return import(pathToFileURL(outfile).href);
  };
  [geometry, numbers, shares] = await Promise.all(["geometry", "numbers", "shares"].map(load));
});

const near = (a, b) => assert.ok(Math.hypot(a.x - b.x, a.y - b.y, a.theta - b.theta) < 1e-12, JSON.stringify([a, b]));

test("poses are put together and undone", () => {
  const quarter = { x: 1, y: 2, theta: Math.PI / 2 };
  near(geometry.compose(quarter, { x: 3, y: 1, theta: 0.5 }), { x: 0, y: 5, theta: Math.PI / 2 + 0.5 });
  near(geometry.inverse(quarter), { x: -2, y: 1, theta: -Math.PI / 2 });
  near(geometry.compose(quarter, geometry.inverse(quarter)), { x: 0, y: 0, theta: 0 });
});

test("angles lie in (-pi, pi]", () => {
  assert.equal(geometry.wrap(Math.PI), Math.PI);
  assert.equal(geometry.wrap(-Math.PI), Math.PI);
  assert.ok(Math.abs(geometry.wrap(7) - (7 - 2 * Math.PI)) < 1e-12);
  assert.ok(Math.abs(geometry.wrap(-4) - (2 * Math.PI - 4)) < 1e-12);
});

test("boxes leave out what is missing", () => {
  assert.deepEqual(geometry.boundingBox([1, null, -2], [5, 9, 7]), { low: { x: -2, y: 5 }, high: { x: 1, y: 7 } });
  assert.equal(geometry.boundingBox([null], [1]), null);
});

test("shares count what is no larger, of all", () => {
  assert.deepEqual(shares.cumulativeShare({ values: [3, 1, 3], of: 4 }, [0, 1, 2, 3, 9]), [0, 0.25, 0.25, 0.75, 0.75]);
  assert.deepEqual(shares.cumulativeShare({ values: [], of: 0 }, [1, 2]), [null, null]);
});

test("numbers have the digits that mean something", () => {
  const told = [0, 1, 0.00206464, 12345.6, -0.5, 1e-9, 999.6].map((value) => numbers.significant(value));
  assert.deepEqual(told, ["0", "1.00", "0.00206", "12346", "-0.500", "1.00e-9", "1000"]);
  assert.equal(numbers.significant(null), "–");
  assert.equal(numbers.proportion({ value: 1, low: 0.9162, high: 1 }), "100.0 % (91.6 to 100.0 %)");
  assert.deepEqual([3.2, 300, 9000].map(numbers.duration), ["4 s", "5 min", "2.5 h"]);
});

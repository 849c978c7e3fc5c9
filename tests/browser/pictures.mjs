// Pictures of reports for a look: each in light and dark, at 1280 and at 400 px, and what the follow camera sees.
//   node tests/browser/pictures.mjs FOLDER REPORT.html…
// The pictures are called after the reports' folders. Needs what report.mjs needs.
import { createRequire } from "node:module";
import path from "node:path";
import { pathToFileURL } from "node:url";

const { chromium } = createRequire(import.meta.url)("playwright-core");
const [folder, ...reports] = process.argv.slice(2);
const flags = ["--no-sandbox", "--disable-dev-shm-usage", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM || "/usr/bin/chromium", args: flags });

async function taken(report, width, colorScheme) {
  const page = await browser.newPage({ viewport: { width, height: 1000 }, colorScheme });
  const start = Date.now();
  await page.goto(pathToFileURL(path.resolve(report)).href);
  await page.waitForSelector("html[data-ready='1']", { timeout: 120_000, state: "attached" });
  const ready = Date.now() - start, name = path.basename(path.dirname(path.resolve(report)));
  const picture = (what) => path.join(folder, `${name}-${colorScheme}-${width}${what}.png`);
  const sideways = await page.locator("body").evaluate((body) => body.scrollWidth - body.clientWidth);
  await page.screenshot({ path: picture(""), fullPage: true });
  if (await page.locator("#follow").count() && await page.locator("#time").isEnabled()) {
    // Where the plan's ghost stands apart from the robot, near.
    await page.locator("#follow").check();
    await page.evaluate(() => new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn))));
    await page.locator("#space").screenshot({ path: picture("-near") });
  }
  console.log(`${name} ${colorScheme} ${width}: drawn after ${ready} ms${sideways > 1 ? `, scrolls sideways by ${sideways} px` : ""}`);
  await page.close();
}

for (const report of reports) for (const width of [1280, 400]) for (const scheme of ["light", "dark"]) await taken(report, width, scheme);
await browser.close();

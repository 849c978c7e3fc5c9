// Opens a report in headless Chromium, uses it as a reader would, and saves a picture of it.
//   node tests/browser/report.mjs REPORT.html OUT.png
// Needs the package playwright-core (found through NODE_PATH as well) and Chromium (CHROMIUM, or /usr/bin/chromium).
import assert from "node:assert/strict";
import { createRequire } from "node:module";
import path from "node:path";
import { pathToFileURL } from "node:url";

const { chromium } = createRequire(import.meta.url)("playwright-core");
const [report, picture] = process.argv.slice(2);
if (!report || !picture) {
  console.error("usage: node report.mjs REPORT.html OUT.png");
  process.exit(2);
}
const url = pathToFileURL(path.resolve(report)).href;
const flags = ["--no-sandbox", "--disable-dev-shm-usage", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
  "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM || "/usr/bin/chromium", args: flags });
const size = { width: 1380, height: 1000 };

async function withScript() {
  const page = await browser.newPage({ viewport: size });
  const complaints = [], outside = [];
  page.on("console", (message) => { if (message.type() === "error") complaints.push(message.text()); });
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("request", (request) => { if (!/^(file|data|blob):/.test(request.url())) outside.push(request.url()); });
  await page.goto(url);
  await page.waitForSelector("html[data-ready='1']", { timeout: 120_000, state: "attached" });
  assert.deepEqual(complaints, [], "console");
  assert.deepEqual(outside, [], "requests that leave the file");
  assert.ok(await page.locator("h1 .outcome").innerText(), "verdict");
  await page.screenshot({ path: picture, fullPage: true });

  const options = await page.locator("#pick option").count();
  if (options > 0) {
    assert.equal(await page.locator("#space canvas").count() > 0, true, "3D view");
    const shown = page.locator("figure.case:not([hidden])");
    assert.equal(await shown.count(), 1);
    const slider = page.locator("#time");
    if (await slider.isEnabled()) {
      const before = await page.locator("#moment").innerText();
      await slider.fill("0");
      const after = await page.locator("#moment").innerText();
      assert.match(after, /^t = 0\.00 s/, "slider");
      await page.locator("#worst-moment").click();
      assert.equal(await page.locator("#moment").innerText(), before, "worst moment");
    }
  }
  if (options > 1) {
    const second = page.locator("tr.shown").nth(1);
    const id = await second.getAttribute("data-case");
    await second.click();
    await page.waitForSelector(`figure.case[data-case='${id}']:not([hidden])`);
    assert.equal(await page.locator("#case-id").innerText(), id, "row selects its case");
    const head = page.locator("table.cases thead th").nth(2);
    await head.locator("button").click();
    assert.equal(await head.getAttribute("aria-sort"), "descending");
    const column = await page.locator("table.cases tbody tr td:nth-child(3)").allInnerTexts();
    const numbers = column.filter((text) => text !== "–").map(Number);
    assert.deepEqual(numbers, [...numbers].sort((a, b) => b - a), "sorted column");
  }
  assert.deepEqual(complaints, [], "console after use");
  await page.close();
}

async function withoutScript() {
  const context = await browser.newContext({ javaScriptEnabled: false, viewport: size });
  const page = await context.newPage();
  await page.goto(url);
  assert.ok(await page.locator("h1 .outcome").innerText(), "verdict without script");
  assert.ok(await page.locator("table.cases tbody tr").count() > 0 || await page.locator("h1").count() > 0, "table without script");
  if (await page.locator("figure.case").count()) assert.ok(await page.locator("figure.case svg.views").first().isVisible(), "drawing without script");
  await page.screenshot({ path: picture.replace(/(\.png)?$/, ".noscript.png"), fullPage: true });
  await context.close();
}

async function narrow() {
  const page = await browser.newPage({ viewport: { width: 420, height: 900 } });
  await page.goto(url);
  await page.waitForSelector("html[data-ready='1']", { timeout: 120_000, state: "attached" });
  const overflow = await page.locator("body").evaluate((body) => body.scrollWidth - body.clientWidth);
  assert.ok(overflow <= 1, `a phone scrolls sideways by ${overflow} px`);
  await page.close();
}

try {
  await withScript();
  await withoutScript();
  await narrow();
  console.log(`${report}: ok`);
} finally {
  await browser.close();
}

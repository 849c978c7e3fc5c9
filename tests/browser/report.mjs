// Opens a report in headless Chromium, uses it as a reader would, and saves pictures of it.
//   node tests/browser/report.mjs REPORT.html OUT.png
// Needs the package playwright-core (found through NODE_PATH as well) and Chromium (CHROMIUM, or /usr/bin/chromium).
import assert from "node:assert/strict";
import { statSync } from "node:fs";
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
const told = (name) => picture.replace(/(\.png)?$/, name ? `.${name}.png` : ".png");

/** A page that is drawn, and what it must not do. */
async function opened(width, colorScheme, hash = "") {
  const context = await browser.newContext({ viewport: { width, height: 1000 }, colorScheme, acceptDownloads: true });
  const page = await context.newPage(), complaints = [], outside = [];
  page.on("console", (message) => { if (message.type() === "error") complaints.push(message.text()); });
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("request", (request) => { if (!/^(file|data|blob):/.test(request.url())) outside.push(request.url()); });
  const start = Date.now();
  await page.goto(url + hash);
  await page.waitForSelector("html[data-ready='1']", { timeout: 120_000, state: "attached" });
  const close = async () => {
    assert.deepEqual(complaints, [], "console");
    assert.deepEqual(outside, [], "requests that leave the file");
    await context.close();
  };
  return { page, close, ready: Date.now() - start };
}

/** Verdict, cards, table and picture name one case, one moment and one value. */
async function agrees(page) {
  const verdict = await page.locator("h1").innerText();
  const named = /worst (.+?), case (\d+), t = (-?[\d.]+) s, leg (\d+→\d+)/.exec(verdict);
  if (!named) return;
  const [, finding, id, t, leg] = named;
  assert.equal(await page.locator("#case-id").innerText(), id, "the case that the verdict names");
  const moment = await page.locator("#moment").innerText();
  if (!moment.startsWith("nothing")) assert.ok(moment.startsWith(`t = ${t} s`), `opened at ${moment}, not at ${t} s`);
  const cards = await page.locator(".cards").innerText();
  assert.ok(cards.includes(id) && cards.includes(`t = ${t} s, leg ${leg}`), `cards: ${cards}`);
  const measured = /(-?[\d.]+ ?\S*) [><≤≥] (-?[\d.]+ ?\S*)$/.exec(finding);
  if (measured) assert.ok(cards.includes(measured[1]) && cards.includes(`limit ${measured[2]}`), `cards: ${cards}`);
  else assert.ok(cards.includes(finding), `cards: ${cards}`);
  const row = await page.locator(`tr[data-case='${id}']`).innerText();
  if (/[><]/.test(finding) || !measured) assert.ok(row.includes(`at t=${t} s`), `table: ${row}`);
  // A deviation has no name before it: it has the same digits in the picture and in the table, whether or not it passes.
  if (measured && finding.startsWith(measured[1])) {
    assert.ok(moment.includes(`deviation ${measured[1]}`), `moment: ${moment}`);
    assert.ok(row.includes(measured[1].split(" ")[0]), `table: ${row}`);
  }
  assert.ok((await page.locator("#told").innerText()).includes(`t=${t} s`), "what stands over the picture");
}

/** How many pixels of the picture are not paper. */
const inked = (page) => page.locator("#space").screenshot().then((bytes) => bytes.length);

/** The frame that follows what was just asked for is on the screen. */
const drawn = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

/** Waits until what is read differs from what it was: a loaded machine may take seconds to draw one picture. */
async function changes(read, from, what) {
  const last = Date.now() + 60_000;
  for (;;) {
    const now = await read();
    if (Buffer.compare(Buffer.from(now), Buffer.from(from)) !== 0) return now;
    assert.ok(Date.now() < last, what);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}

async function used() {
  const { page, close, ready } = await opened(1280, "light");
  console.log(`${report}: ${(statSync(report).size / 1e6).toFixed(2)} MB, drawn after ${ready} ms`);
  assert.ok(await page.locator("h1 .outcome").innerText(), "verdict");
  await page.screenshot({ path: told(""), fullPage: true });
  const options = await page.locator("#pick option").count();
  if (options > 0) {
    await agrees(page);
    assert.equal(await page.locator("#space canvas").count(), 2, "3D view");
    assert.ok(await inked(page) > 5000, "the picture is empty");
    const slider = page.locator("#time"), moment = page.locator("#moment");
    if (await slider.isEnabled()) {
      const before = await moment.innerText();
      await slider.fill("0");
      assert.match(await moment.innerText(), /^t = 0\.00 s/, "slider");
      await page.locator("#worst-moment").click();
      assert.equal(await moment.innerText(), before, "worst moment");
      // Keys and mouse.
      await page.locator("#gl").focus();
      await page.keyboard.press(",");
      assert.notEqual(await moment.innerText(), before, "a step back");
      await page.keyboard.press("w");
      assert.equal(await moment.innerText(), before, "w");
      const shot = () => page.locator("#space").screenshot();
      const straight = await shot();
      await page.keyboard.press("ArrowLeft");
      const turned = await changes(shot, straight, "keys turn it");
      const box = await page.locator("#gl").boundingBox();
      await page.mouse.move(box.x + 200, box.y + 200);
      await page.mouse.down();
      await page.mouse.move(box.x + 320, box.y + 240, { steps: 4 });
      await page.mouse.up();
      await page.mouse.wheel(0, -300);
      await changes(shot, turned, "the mouse turns it");
      await page.locator("#fit").click();
      await page.locator("#play").click();
      await changes(() => moment.innerText(), before, "it plays");
      await page.locator("#play").click();
      await page.locator("#worst-moment").click();
      await page.locator("#follow").check();
      await drawn(page);
      await page.locator("#space").screenshot({ path: told("near") });
      await page.locator("#follow").uncheck();
    }
    const [file] = await Promise.all([page.waitForEvent("download"), page.locator("#png").click()]);
    assert.match(file.suggestedFilename(), /^hairpin-\d+-.*\.png$/);
    if (await page.locator("#commands").count()) { // a page of logs has none
      await page.locator("#commands button[data-verb=replay]").click();
      assert.match(await page.locator("#command").innerText(), /^hairpin replay .+ --case \d+$/, "a command to copy");
    }
    for (const keys of await page.locator(".keys").all()) {
      const [k, charts] = [await keys.boundingBox(), await page.locator("svg.chart, #space").all()];
      for (const chart of charts) {
        const c = await chart.boundingBox();
        assert.ok(!k || !c || k.y + k.height <= c.y + 1 || k.y >= c.y + c.height - 1, "a legend over a curve");
      }
    }
  }
  if (options > 1) {
    const second = page.locator("tr.shown").nth(1), id = await second.getAttribute("data-case");
    await second.locator("td").nth(2).click();
    assert.equal(await page.locator("#case-id").innerText(), id, "row selects its case");
    assert.ok(page.url().endsWith("#" + id), "a link to the case");
    const head = page.locator("table.cases thead th").nth(2);
    await head.locator("button").click();
    assert.equal(await head.getAttribute("aria-sort"), "descending");
    const column = await page.locator("table.cases tbody tr td:nth-child(3)").allInnerTexts();
    const numbers = column.filter((text) => text !== "–").map(Number);
    assert.deepEqual(numbers, [...numbers].sort((a, b) => b - a), "sorted column");
    const linked = await opened(1280, "light", "#" + id);
    assert.equal(await linked.page.locator("#case-id").innerText(), id, "the link opens its case");
    await linked.close();
  }
  if (await page.locator("#spread rect.hit").count()) {
    const rows = () => page.locator("table.cases tbody tr:visible").count(), all = await rows();
    const bar = page.locator("#spread rect.hit").first(), label = await bar.getAttribute("aria-label");
    await bar.focus();
    await page.keyboard.press("Enter");
    assert.equal(await rows(), Math.min(all, Number.parseInt(label, 10)), "a bar chooses its cases");
    await page.locator("#all-cases").click();
    assert.equal(await rows(), all, "all cases again");
    const dot = page.locator("#scatter .dot").last(), name = (await dot.getAttribute("aria-label")).replace("case ", "");
    await dot.click({ force: true });
    if (await page.locator(`tr.shown[data-case='${name}']`).count()) assert.equal(await rows(), 1, "a dot chooses its case");
  }
  await close();
}

/** Dark, and on a phone: nothing sideways, the picture first. */
async function elsewhere() {
  for (const [width, scheme] of [[1280, "dark"], [400, "light"], [400, "dark"]]) {
    const { page, close } = await opened(width, scheme);
    const overflow = await page.locator("body").evaluate((body) => body.scrollWidth - body.clientWidth);
    assert.ok(overflow <= 1, `${width} px scroll sideways by ${overflow} px`);
    const paper = await page.locator("body").evaluate((body) => getComputedStyle(body).backgroundColor);
    const light = paper.match(/\d+/g).map(Number).reduce((a, b) => a + b) > 380;
    assert.equal(light, scheme === "light", `${scheme}: ${paper}`);
    if (width === 400 && await page.locator("#space").count()) {
      const top = async (what) => (await page.locator(what).first().boundingBox()).y;
      assert.ok(await top("#space") < await top(".cards") && await top("#space") < await top(".findings:visible"), "the picture comes first");
    }
    await page.screenshot({ path: told(`${scheme}-${width}`), fullPage: true });
    await close();
  }
}

async function withoutScript() {
  const context = await browser.newContext({ javaScriptEnabled: false, viewport: { width: 1280, height: 1000 } });
  const page = await context.newPage();
  await page.goto(url);
  assert.ok(await page.locator("h1 .outcome").innerText(), "verdict without script");
  assert.ok(await page.locator("table.cases tbody tr").count() > 0 || await page.locator("h1").count() > 0, "table without script");
  if (await page.locator("figure.case").count()) assert.ok(await page.locator("figure.case svg.views").first().isVisible(), "drawing without script");
  await page.screenshot({ path: told("noscript"), fullPage: true });
  await context.close();
}

try {
  await used();
  await elsewhere();
  await withoutScript();
  console.log(`${report}: ok`);
} finally {
  await browser.close();
}

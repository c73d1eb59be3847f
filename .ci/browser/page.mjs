// Tests a report in a browser: node page.mjs DIR. It prints the errors and then exits with 1.
import fs from "node:fs";
import path from "node:path";
import { pathToFileURL } from "node:url";
import puppeteer from "puppeteer-core";

const dir = path.resolve(process.argv[2]);
const file = path.join(dir, "index.html");
const address = pathToFileURL(file).href;
const axe = fs.readFileSync(new URL("node_modules/axe-core/axe.min.js", import.meta.url), "utf8");
const wrong = [];
const check = (holds, what) => { if (!holds) wrong.push(what); };
const pause = (milliseconds) => new Promise((done) => { setTimeout(done, milliseconds); });

const found = ["chromium", "chromium-browser", "google-chrome"].flatMap((name) => process.env.PATH.split(":").map((at) => path.join(at, name)));
const executablePath = found.find((at) => fs.existsSync(at));
if (!executablePath) { console.error("chromium is missing."); process.exit(1); }
const browser = await puppeteer.launch({
  executablePath,
  args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"],
});

// `at` is what follows the file in the address: a query, an anchor or both.
const open = async (width, { dark = false, script = true, at = "" } = {}) => {
  const page = await browser.newPage();
  page.on("console", (message) => wrong.push(`console at ${width}: ${message.text()}`));
  page.on("pageerror", (error) => wrong.push(`error at ${width}: ${error.message}`));
  page.on("request", (request) => { if (!/^(file|data|blob):/.test(request.url())) wrong.push(`asked the network for ${request.url()}`); });
  await page.setJavaScriptEnabled(script);
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: dark ? "dark" : "light" }]);
  await page.setViewport({ width, height: 900 });
  await page.goto(address + at, { waitUntil: "load" });
  return page;
};

// It is light, short, and nowhere wider than the screen; nobody is kept from reading it.
check(fs.statSync(file).size <= 2_500_000, `the page weighs ${fs.statSync(file).size} bytes`);
for (const width of [1440, 1024, 390]) {
  for (const dark of [false, true]) {
    const page = await open(width, { dark });
    const [wide, high] = await page.evaluate(() => [document.documentElement.scrollWidth, document.documentElement.scrollHeight]);
    check(wide <= width, `at ${width} the page is ${wide} wide`);
    if (width === 1440) check(high <= 40 * 900, `the page is ${(high / 900).toFixed(1)} screens long`);
    await page.evaluate(() => { document.querySelectorAll("details").forEach((details) => { details.open = true; }); });
    const opened = await page.evaluate(() => document.documentElement.scrollWidth);
    check(opened <= width, `at ${width}, all opened, the page is ${opened} wide`);
    const cut = await page.evaluate(() => [...document.querySelectorAll("table.verdicts td:first-child")].filter((cell) => cell.getClientRects().length && cell.getBoundingClientRect().right > innerWidth).length);
    check(cut === 0, `at ${width} ${cut} verdicts are off the screen`);
    await page.evaluate(() => { document.querySelectorAll(".case details").forEach((details) => { details.open = false; }); });
    if (width !== 1024) {
      await page.evaluate(axe);
      const serious = await page.evaluate(async () => (await axe.run()).violations
        .filter((violation) => ["serious", "critical"].includes(violation.impact))
        .map((violation) => `${violation.id}: ${violation.nodes.length} × ${violation.nodes[0].html.slice(0, 160)} ${violation.nodes[0].failureSummary.slice(0, 200)}`));
      for (const violation of serious) wrong.push(`axe at ${width}${dark ? ", dark" : ""}: ${violation}`);
    }
    await page.close();
  }
}

const page = await open(1440);
const timing = await page.evaluate(() => performance.getEntriesByName("first-contentful-paint").map((entry) => entry.startTime)[0]);
console.log(`first paint after ${Math.round(timing)} ms`);
const shown = () => page.evaluate(() => [...document.querySelectorAll("table.verdicts tbody tr")].filter((row) => !row.hidden).map((row) => ({ id: row.id, solver: row.dataset.s, outcome: row.dataset.o, text: row.textContent.toLowerCase(), visible: row.checkVisibility() })));
const all = (await shown()).length;

// Filter: only what fits is shown, and all of it, opened.
const [solver] = await page.evaluate(() => [document.querySelector("table.verdicts tbody tr").dataset.s]);
await page.select("#by-solver", solver);
let rows = await shown();
check(rows.length > 0 && rows.length < all && rows.every((row) => row.solver === solver && row.visible), `filter by ${solver}: ${rows.length} of ${all} rows`);
await page.select("#by-outcome", "pass");
rows = await shown();
check(rows.every((row) => row.solver === solver && row.outcome === "pass"), "filter by solver and outcome");
await page.click("#clear");
check((await shown()).length === all, "clearing shows all rows again");
await page.keyboard.press("/");
await page.keyboard.type("velocity");
await pause(300);
rows = await shown();
const sections = await page.evaluate(() => [...document.querySelectorAll("section.case")].filter((section) => !section.hidden).every((section) => section.querySelector("table.verdicts tbody tr:not([hidden])")));
check(rows.length > 0 && rows.length < all && sections, `search: ${rows.length} of ${all} rows`);
await page.evaluate(() => { document.activeElement.blur(); });
await page.keyboard.press("Escape");
await page.focus("#search");
await page.keyboard.type("no such word anywhere");
await pause(300);
check((await shown()).length === 0, "a search for what is not there finds something");
await page.keyboard.press("Escape");
check((await shown()).length === all, "Escape shows all rows again");

// Filters are in the address: a reload keeps them, and a shared link has them. Cleared, the address has none.
await page.select("#by-solver", solver);
await page.focus("#search");
await page.keyboard.type("velocity");
await pause(300);
const filtered = (await shown()).map((row) => row.id);
const query = await page.evaluate(() => location.search);
check(filtered.length > 0 && new URLSearchParams(query).get("solver") === solver && query.includes("q=velocity"), `filters in the address: ${query}`);
await page.reload({ waitUntil: "load" });
check((await shown()).map((row) => row.id).join() === filtered.join(), "a reload loses the filters");
const shared = await open(1440, { at: query });
const inShared = await shared.evaluate(() => [...document.querySelectorAll("table.verdicts tbody tr:not([hidden])")].map((row) => row.id));
check(inShared.join() === filtered.join(), "a shared link loses the filters");
await shared.close();
await page.click("#clear");
check(await page.evaluate(() => location.search) === "" && (await shown()).length === all, "cleared filters stay in the address");

// Enter leads to the first hit: a row whose quantity has the word, although rows before it have the word elsewhere.
await page.focus("#search");
await page.keyboard.type("velocity");
await page.keyboard.press("Enter");
await pause(600);
const hit = await page.evaluate(() => {
  const row = document.querySelector("table.verdicts tr:target"), box = row?.getBoundingClientRect();
  const visible = [...document.querySelectorAll("table.verdicts tbody tr:not([hidden])")];
  const named = visible.filter((one) => one.cells[1].textContent.toLowerCase().includes("velocity"));
  return { isFirst: row === named[0], isSeen: box?.top >= 0 && box?.bottom <= innerHeight, named: named.length, all: visible.length, text: document.querySelector("#found b").textContent };
});
check(hit.isFirst && hit.isSeen, `Enter does not lead to the first hit: ${JSON.stringify(hit)}`);
check(hit.named === hit.all || hit.text.includes(`${hit.named} by their quantity`), `hits by quantity: ${JSON.stringify(hit)}`);
await page.evaluate(() => { history.replaceState(null, "", location.pathname + location.search); });
await page.click("#clear");

// Each count leads to its rows and says what it means.
const counts = await page.evaluate(() => [...document.querySelectorAll(".counts a[data-outcome]:not([data-solver])")].map((link) => ({ outcome: link.dataset.outcome, count: Number(link.querySelector("b").textContent), title: link.title })));
check(counts.length > 0 && counts.every(({ title }) => title), `counts: ${JSON.stringify(counts)}`);
for (const { outcome, count, title } of counts) {
  await page.evaluate((outcome) => { document.querySelector(`.counts a[data-outcome="${outcome}"]:not([data-solver])`).click(); }, outcome);
  rows = await shown();
  const there = rows.length <= count && rows.every((row) => row.outcome === outcome) && (await page.$eval("#found", (found) => found.textContent)).includes(title);
  check(there, `the count of ${outcome}: ${rows.length} of ${count} rows`);
}
await page.click("#clear");

// A solver without a judged result has no fraction, which would read as a failure.
const unjudged = await page.evaluate(() => { const all = ["unsupported", "no-reference", "not-available"]; const rows = [...document.querySelectorAll("table.verdicts tbody tr")]; return [...new Set(rows.map((row) => row.dataset.s))].filter((solver) => rows.every((row) => row.dataset.s !== solver || all.includes(row.dataset.o))); });
for (const name of unjudged) {
  await page.select("#by-solver", name);
  const text = await page.$eval("#found li", (item) => item.textContent);
  check(text.includes("none judged") && !/\d\/\d/.test(text), `${name}: ${text}`);
}
await page.click("#clear");

// Pictures of buttons need no font.
const icons = await page.evaluate(() => [...document.querySelectorAll(".act button, .cite button")].map((button) => [button.textContent, button.querySelector("svg path") !== null]));
check(icons.length > 0 && icons.every(([text, isDrawn]) => text === "" && isDrawn), "a button has no picture");

// Citations: as text and as BibTeX, with the commit; the button copies them.
const cited = await page.evaluate(() => [...document.querySelectorAll(".cite")].map((one) => { one.querySelector("button").click(); return [one.querySelector("pre").textContent, document.documentElement.dataset.copied]; }));
check(cited.length === 2 && cited.every(([text, copy]) => text === copy && /commit \S/.test(text)) && cited[1][0].startsWith("@software{"), `citations: ${JSON.stringify(cited)}`);

// Sort: by numbers, both ways.
const order = () => page.evaluate(() => [...document.querySelectorAll("table.verdicts")][0].tBodies[0]).then(() => page.evaluate(() => [...document.querySelector("table.verdicts").tBodies[0].rows].map((row) => Number(row.cells[4].dataset.v)).filter((value) => !Number.isNaN(value))));
const sort = () => page.evaluate(() => { const details = document.querySelector("table.verdicts").closest("details"); details.open = true; document.querySelectorAll("table.verdicts thead th button")[4].click(); });
await sort();
let values = await order();
check(values.length > 1 && values.every((value, at) => at === 0 || values[at - 1] <= value), "sort by error");
await sort();
values = await order();
check(values.every((value, at) => at === 0 || values[at - 1] >= value), "sort by error, the other way round");

// A row as text.
const copied = await page.evaluate(() => { document.querySelector("table.verdicts .act button").click(); return document.documentElement.dataset.copied; });
check(copied && copied.includes(" · ") && !copied.includes("§"), `copied: ${copied}`);

// A cell of the matrix leads to its rows.
const cell = await page.evaluate(() => { const link = document.querySelector(".matrix a[data-solver]"); link.click(); return { solver: link.dataset.solver, case: link.dataset.case }; });
rows = await shown();
check(rows.length > 0 && rows.every((row) => row.solver === cell.solver), "a cell of the matrix leads to its rows");
await page.click("#clear");

// Films run, and stop when asked.
const film = await page.$(".film");
if (film) {
  await film.evaluate((of) => { for (let up = of; up; up = up.parentElement) if (up.tagName === "DETAILS") up.open = true; of.scrollIntoView(); });
  await pause(800);
  const frame = () => film.evaluate((of) => of.dataset.frame);
  const before = await frame();
  await pause(500);
  check(before !== await frame(), "a film does not run");
  await (await film.$("button")).click();
  const stopped = await frame();
  await pause(500);
  check(stopped === await frame() && await film.evaluate((of) => of.querySelector("button").textContent) === "Play", "a film does not stop");
} else {
  wrong.push("there is no film to try");
}
await page.close();

// The first screen: three questions, each with a picture and a link to its section.
const first = await open(1440);
const questions = await first.evaluate(() => [...document.querySelectorAll(".question")].map((question) => ({
  bottom: question.getBoundingClientRect().bottom,
  holds: question.querySelector(".plot svg") !== null && document.querySelector(question.querySelector("h2 a").hash) !== null,
})));
check(questions.length === 3 && questions.every(({ bottom, holds }) => bottom <= 900 && holds), `first screen: ${JSON.stringify(questions)}`);
await first.close();

// The three ways from the first screen, each by a watch that starts where the page is seen.
const ways = await open(1440);
const watch = async (question, answer) => {
  const begun = performance.now();
  const found = await answer();
  console.log(`${question}: ${found} (${Math.round(performance.now() - begun)} ms)`);
  check(found, question);
};
await watch("who is right about rolling with friction: typed `rolling`", async () => {
  await ways.keyboard.press("/");
  await ways.keyboard.type("rolling");
  await pause(300);
  const rows = await ways.evaluate(() => [...document.querySelectorAll("table.verdicts tbody tr:not([hidden])")].map((row) => [row.dataset.s, row.dataset.o]));
  const of = (solver) => rows.filter(([name]) => name === solver);
  const told = ["rigid", "mpm", "mpm:2000"].filter((solver) => of(solver).length > 0);
  return told.length === 3 && told.map((solver) => `${solver} ${of(solver).filter(([, outcome]) => outcome === "pass").length} of ${of(solver).length}`).join(", ");
});
await ways.keyboard.press("Escape");
await watch("what mpm:2000 gets wrong: its card", () => ways.evaluate(() => {
  const card = document.querySelector('[data-card="mpm:2000"]');
  const text = card?.checkVisibility() ? card.textContent : "";
  return /\d×|error \d/.test(text) && text.replace(/\s+/g, " ").slice(0, 200);
}));
await watch("what 1 % costs by mpm and by dem: the table beside the picture", () => ways.evaluate(() => {
  const cells = (row) => [...row.cells].map((cell) => cell.textContent.trim());
  const at = (head) => head.findIndex((text) => text.replace(/\s/g, "") === "1%");
  const tables = [...document.querySelectorAll("table")].filter((table) => table.checkVisibility()).map((table) => [...table.rows].map(cells));
  const rows = tables.find(([head]) => at(head) > 0) ?? [[]];
  const told = rows.filter((row) => ["dem", "mpm"].includes(row[0]) && row[at(rows[0])]).map((row) => `${row[0]} ${row[at(rows[0])]}`);
  return told.length === 2 && told.join(", ");
}));
await ways.close();

// Anchors, with a script and without: the row that is asked for is opened and seen.
const id = await (async () => { const first = await open(1440); const found = await first.evaluate(() => [...document.querySelectorAll("table.verdicts tbody tr")].at(-1).id); await first.close(); return found; })();
for (const script of [true, false]) {
  const page = await open(1440, { script, at: `#${id}` });
  await pause(400);
  const row = await page.$(`#${id}`);
  check(await row.isVisible(), `#${id} is not opened ${script ? "with" : "without"} a script`);
  if (!script) check(!(await (await page.$("#tools")).isVisible()), "tools that need a script are shown without one");
  await page.close();
}

// On a phone, the heads of tables stay while their boxes scroll.
const phone = await open(390);
const stuck = await phone.evaluate(() => {
  document.querySelectorAll("details").forEach((details) => { details.open = true; });
  return [...document.querySelectorAll(".scroll > table")].filter((table) => table.tHead?.checkVisibility()).map((table) => {
    const box = table.parentElement;
    box.scrollTop = 60;
    const moved = box.scrollTop, apart = table.tHead.rows[0].cells[0].getBoundingClientRect().top - box.getBoundingClientRect().top;
    return { name: box.getAttribute("aria-label"), isStuck: moved === 0 || Math.abs(apart) < 2, position: getComputedStyle(table.tHead.rows[0].cells[0]).position, moved };
  });
});
check(stuck.some(({ name }) => name === "Hard cases by solver"), "the table of hard cases is missing");
for (const { name, isStuck, position } of stuck) check(isStuck && position === "sticky", `the heading of ${name} does not stay`);
check(stuck.some(({ moved }) => moved > 0), "no table scrolls on a phone");
await phone.close();

// In print, tables are open and a film shows its still frame. Contents have no page numbers, so they are hidden.
const print = await open(1440);
await print.emulateMediaType("print");
const inPrint = await print.evaluate(() => ({
  row: document.querySelector("table.verdicts tbody tr").getClientRects().length,
  still: document.querySelector(".film image")?.getBoundingClientRect().width ?? 1,
  contents: document.querySelector(".contents a").getClientRects().length,
  tools: document.querySelector("#tools").getClientRects().length,
}));
// A heading and the part below it are on one page: no break may follow it, and its parent is no flexible box, where browsers
// ignore this.
const alone = await print.evaluate(() => [...document.querySelectorAll(":is(section, .overview) :is(h2, h3, h4, summary)")].filter((head) => head.getClientRects().length)
  .filter((head) => getComputedStyle(head).breakAfter !== "avoid" || !/^(block|list-item|flow-root)$/.test(getComputedStyle(head.parentElement).display))
  .map((head) => `${head.tagName} ${head.textContent.slice(0, 40)}`));
check(alone.length === 0, `headings that can end a page: ${alone.length}, ${alone.slice(0, 4).join("; ")}`);
check(inPrint.still > 0 && inPrint.contents === 0 && inPrint.tools === 0, `print: ${JSON.stringify(inPrint)}`);
await print.close();

await browser.close();
for (const what of wrong) console.error(what);
console.log(wrong.length ? `${wrong.length} things are wrong` : "the page holds");
process.exit(wrong.length ? 1 : 0);

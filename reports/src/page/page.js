// Functions of the page: search, filter, sort, copy a row or a citation, stop a film, change colours.
// Without it the page is whole, and everything is there to be read.
"use strict";
(() => {
  const all = (what, within = document) => [...within.querySelectorAll(what)];
  const root = document.documentElement;
  const make = (name, text, more = {}) => Object.assign(document.createElement(name), { textContent: text }, more);

  // Colours: as the system has them, until somebody says otherwise.
  const theme = document.getElementById("theme");
  if (theme) {
    theme.hidden = false;
    theme.addEventListener("click", () => {
      const isDark = root.dataset.theme ? root.dataset.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
      root.dataset.theme = isDark ? "light" : "dark";
    });
  }

  // Copies a text; the button shows a tick for a moment. The pictures need no font.
  const icon = (path) => `<svg viewBox="0 0 16 16" width="1em" height="1em" fill="none" stroke="currentColor" stroke-width="1.6" aria-hidden="true"><path d="${path}"/></svg>`;
  const COPY = icon("M5.5 5.5h8v8h-8zM2.5 10.5v-8h8"), DONE = icon("M2 8.5l4 4 8-9");
  const copied = async (button, text) => {
    root.dataset.copied = text;
    try { await navigator.clipboard.writeText(text); } catch {
      const area = make("textarea", text);
      document.body.append(area);
      area.select();
      document.execCommand("copy");
      area.remove();
    }
    button.innerHTML = DONE;
    setTimeout(() => { button.innerHTML = COPY; }, 1200);
  };
  for (const text of all(".cite pre")) {
    const copy = make("button", "", { type: "button", title: "Copy this citation", innerHTML: COPY });
    copy.setAttribute("aria-label", "Copy this citation");
    copy.addEventListener("click", () => copied(copy, text.textContent));
    text.before(copy);
  }

  // Films: frames are differences to the frame before, packed; they run until somebody stops them.
  const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const unpack = async (text) =>
    new Uint8Array(await new Response(new Blob([bytes(text)]).stream().pipeThrough(new DecompressionStream("deflate"))).arrayBuffer());
  const play = async (film) => {
    const data = film.dataset.film.split(" ");
    const [width, height, count] = data.slice(0, 3).map(Number);
    const palette = bytes(data[3]), frames = await unpack(data[4]), size = width * height;
    for (let at = size; at < frames.length; at += 1) frames[at] = (frames[at] + frames[at - size]) & 255;
    const canvas = make("canvas", "", { width, height });
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", film.dataset.title);
    const pen = canvas.getContext("2d"), image = pen.createImageData(width, height);
    const show = (frame) => {
      for (let at = 0; at < size; at += 1) {
        const level = 3 * frames[frame * size + at];
        image.data.set([palette[level], palette[level + 1], palette[level + 2], 255], 4 * at);
      }
      pen.putImageData(image, 0, 0);
      film.dataset.frame = frame;
    };
    const still = film.querySelector("image");
    const button = film.querySelector("button");
    const place = document.createElementNS("http://www.w3.org/2000/svg", "foreignObject");
    for (const side of ["x", "y", "width", "height"]) place.setAttribute(side, still.getAttribute(side));
    canvas.style.cssText = "width:100%;height:100%;display:block;image-rendering:auto";
    place.append(canvas);
    let frame = count - 1, timer = 0;
    const set = (isOn) => {
      clearInterval(timer);
      timer = isOn ? setInterval(() => { frame = (frame + 1) % count; show(frame); }, 100) : 0;
      button.textContent = isOn ? "Pause" : "Play";
      film.dataset.playing = isOn;
    };
    show(frame);
    still.after(place);
    button.hidden = false;
    button.addEventListener("click", () => set(!timer));
    // In print there is the still frame, which lies below.
    addEventListener("beforeprint", () => { place.remove(); });
    addEventListener("afterprint", () => { still.after(place); });
    new IntersectionObserver((seen) => {
      if (!seen[0].isIntersecting) set(false);
      else if (!film.dataset.asked && !matchMedia("(prefers-reduced-motion: reduce)").matches) { film.dataset.asked = "1"; set(true); }
    }).observe(film);
  };
  all(".film").forEach((film) => play(film).catch(() => {}));

  const tools = document.getElementById("tools");
  if (!tools) return;
  tools.hidden = false;
  const search = document.getElementById("search"), found = document.getElementById("found");
  const rows = all("table.verdicts tbody tr").map((row) => ({
    row, section: row.closest("section"), solver: row.dataset.s, outcome: row.dataset.o, evidence: row.cells[5].firstChild.textContent.split(": ")[0],
    source: row.cells[5].firstChild.textContent.split(": ").slice(1).join(": "), case: row.closest("section").dataset.case,
    quantity: row.cells[1].textContent.toLowerCase(), text: (row.closest("section").dataset.words + " " + row.textContent).toLowerCase(),
  }));
  const kinds = ["solver", "case", "source", "outcome", "evidence"];
  const selects = Object.fromEntries(kinds.map((kind) => [kind, document.getElementById("by-" + kind)]));
  for (const kind of kinds) {
    const values = [...new Set(rows.map((row) => row[kind]))];
    if (kind === "source") values.sort();
    for (const value of values) selects[kind].append(make("option", value.length > 60 ? value.slice(0, 58) + "…" : value, { value }));
  }

  const wanted = () => ({ words: search.value.toLowerCase().split(/\s+/).filter(Boolean), ...Object.fromEntries(kinds.map((k) => [k, selects[k].value])) });
  // The address has the filters, so that a reload keeps them and a link shares them.
  const remember = (want) => {
    const query = new URLSearchParams(Object.entries({ q: search.value.trim(), ...want }).filter(([key, value]) => value && key !== "words"));
    const address = `${location.pathname}${query.size ? `?${query}` : ""}${location.hash}`;
    try { if (address !== location.pathname + location.search + location.hash) history.replaceState(null, "", address); } catch { /* The browser keeps the address of a file. */ }
  };
  let opened = [], first = null;
  const apply = () => {
    const want = wanted();
    const isOn = want.words.length > 0 || kinds.some((kind) => want[kind]);
    document.body.classList.toggle("filtering", isOn);
    remember(want);
    const tally = new Map(), cases = new Map();
    let named = 0;
    first = null;
    for (const one of rows) {
      const fits = !isOn || (kinds.every((kind) => !want[kind] || one[kind] === want[kind]) && want.words.every((word) => one.text.includes(word)));
      one.row.hidden = !fits;
      if (!fits) continue;
      // A row whose quantity has the words comes before a row of a case or source with these words.
      const isNamed = want.words.every((word) => one.quantity.includes(word));
      if (isNamed) named += 1;
      if (!first || (isNamed && named === 1)) first = one.row;
      cases.set(one.case, (cases.get(one.case) || 0) + 1);
      const of = tally.get(one.solver) || { pass: 0, judged: 0, all: 0, worst: 0 };
      of.all += 1;
      of.judged += "unjudged" in one.row.dataset ? 0 : 1;
      of.pass += one.outcome === "pass" ? 1 : 0;
      of.worst = Math.max(of.worst, Number(one.row.cells[4].dataset.v || 0));
      tally.set(one.solver, of);
    }
    opened.forEach((details) => { details.open = false; });
    opened = [];
    for (const section of all("section.case")) {
      section.hidden = isOn && !cases.has(section.dataset.case);
      const details = section.querySelector("details.rows-of");
      if (isOn && !section.hidden && details && !details.open) { details.open = true; opened.push(details); }
    }
    for (const row of all(".matrix tbody tr")) row.hidden = isOn && !cases.has(row.dataset.case);
    for (const link of all(".contents a[data-case]")) link.parentElement.hidden = isOn && !cases.has(link.dataset.case);
    found.hidden = !isOn;
    if (!isOn) return;
    const sum = [...tally.values()].reduce((sum, of) => sum + of.all, 0);
    const how = want.words.length && named < sum ? ` ${named} by their quantity, ${sum - named} by case, source or detail.` : "";
    const meaning = want.outcome && document.querySelector(`.counts a[data-outcome="${want.outcome}"]`)?.title;
    found.replaceChildren(make("b", `${sum} of ${rows.length} rows in ${cases.size} cases.${how} `), make("span", meaning ? `${want.outcome}: ${meaning}. ` : ""),
      make("span", `${want.outcome ? "Results" : "Passed of judged results"} by solver, and largest error / tolerance:`));
    const list = document.createElement("ul");
    const part = (of) => (of.judged ? of.pass / of.judged : -1);
    for (const [solver, of] of [...tally].sort((a, b) => part(b[1]) - part(a[1]) || b[1].all - a[1].all)) {
      const item = make("li", ""), worst = of.worst >= 100 ? of.worst.toExponential(0) : Number(of.worst.toPrecision(2));
      const rest = of.all > of.judged ? `, ${of.all - of.judged} not judged` : "";
      item.append(make("b", solver), make("span", !of.judged ? ` none judged (${of.all})` : want.outcome ? ` ${of.all}, worst ${worst}` : ` ${of.pass}/${of.judged}, worst ${worst}${rest}`));
      list.append(item);
    }
    found.append(list);
  };
  const ask = (want) => {
    search.value = want.words || "";
    for (const kind of kinds) selects[kind].value = want[kind] || "";
    apply();
  };
  let soon = 0;
  search.addEventListener("input", () => { clearTimeout(soon); soon = setTimeout(apply, 80); });
  search.addEventListener("keydown", (key) => {
    if (key.key !== "Enter") return;
    clearTimeout(soon);
    apply();
    if (!first || !search.value.trim()) return;
    if (location.hash === `#${first.id}`) reveal();
    else location.hash = first.id;
  });
  for (const kind of kinds) selects[kind].addEventListener("change", apply);
  document.getElementById("clear").addEventListener("click", () => ask({}));
  addEventListener("keydown", (key) => {
    const isTyping = /^(INPUT|SELECT|TEXTAREA)$/.test(document.activeElement.tagName);
    if (key.key === "/" && !isTyping) { key.preventDefault(); search.focus(); search.select(); }
    if (key.key === "Escape") { ask({}); document.activeElement.blur(); }
  });
  // Shows only the rows of a cell or a card.
  document.addEventListener("click", (click) => {
    const link = click.target.closest("a[data-solver], a[data-outcome]");
    if (!link || click.ctrlKey || click.metaKey) return;
    click.preventDefault();
    ask({ solver: link.dataset.solver, case: link.dataset.case, outcome: link.dataset.outcome });
    found.scrollIntoView({ block: "start" });
    const target = document.getElementById(decodeURIComponent(link.hash.slice(1)));
    if (target && link.dataset.case) target.scrollIntoView({ block: "center" });
  });
  // A link to a row that the filter hides shows it again.
  const reveal = () => {
    const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
    if (!target) return;
    if (target.closest("[hidden]")) ask({});
    for (let up = target; up; up = up.parentElement) if (up.tagName === "DETAILS") up.open = true;
    target.scrollIntoView({ block: target.tagName === "TR" ? "center" : "start" });
  };
  addEventListener("hashchange", reveal);
  const asked = new URLSearchParams(location.search);
  if (asked.size) ask({ words: asked.get("q"), ...Object.fromEntries(kinds.map((kind) => [kind, asked.get(kind)])) });
  if (location.hash) reveal();

  // Sort by a column: numbers as numbers, and once more the other way round.
  const value = (row, column) => {
    const cell = row.cells[column];
    return cell.dataset.v === undefined ? cell.innerText.trim() : Number(cell.dataset.v);
  };
  for (const head of all("table.sorts thead th")) {
    const button = make("button", head.textContent, { type: "button" });
    head.replaceChildren(button);
    button.addEventListener("click", () => {
      const turn = head.getAttribute("aria-sort") === "ascending" ? -1 : 1;
      const body = head.closest("table").tBodies[0];
      all("th", head.parentElement).forEach((other) => other.removeAttribute("aria-sort"));
      head.setAttribute("aria-sort", turn > 0 ? "ascending" : "descending");
      const order = [...body.rows].map((row) => [value(row, head.cellIndex), row]);
      order.sort(([a], [b]) => turn * (typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b), "en", { numeric: true })));
      body.append(...order.map(([, row]) => row));
    });
  }

  // A row as text.
  const words = (row) => {
    const section = row.closest("section").dataset.case;
    const cells = [...row.cells].map((cell) => {
      const copy = cell.cloneNode(true);
      all(".act", copy).forEach((act) => act.remove());
      return [...copy.childNodes].map((part) => part.textContent.trim()).filter(Boolean).join(", ");
    });
    return [section, ...cells].filter(Boolean).join(" · ");
  };
  for (const { row } of rows) {
    const act = make("span", "", { className: "act" });
    const link = make("a", "§", { href: `#${row.id}` });
    link.setAttribute("aria-label", "Link to this row");
    const copy = make("button", "", { type: "button", title: "Copy this row as text", innerHTML: COPY });
    copy.setAttribute("aria-label", "Copy this row as text");
    act.append(link, copy);
    row.cells[0].prepend(act);
  }
  document.addEventListener("click", (click) => {
    const button = click.target.closest(".act button");
    if (button) copied(button, words(button.closest("tr")));
  });

  // Boxes that scroll can be reached by keyboard.
  if (matchMedia("(max-width: 46rem)").matches) {
    for (const box of all(".plot.graph")) Object.assign(box, { tabIndex: 0, role: "region", ariaLabel: box.querySelector("title, img")?.textContent || "figure" });
  }

  // Contents say where one is.
  const links = new Map(all(".contents a").map((link) => [link.hash.slice(1), link]));
  const watch = new IntersectionObserver((seen) => {
    for (const { isIntersecting, target } of seen) {
      if (!isIntersecting) continue;
      links.forEach((link) => link.removeAttribute("aria-current"));
      const link = links.get(target.id);
      if (link) { link.setAttribute("aria-current", "true"); }
    }
  }, { rootMargin: "-10% 0px -80% 0px" });
  all("header[id], section[id]").forEach((section) => watch.observe(section));
  if (matchMedia("(max-width: 75rem)").matches) all(".contents details").forEach((details) => { details.open = false; });
})();

"use strict";
(() => {
  const all = (selector, root = document) => [...root.querySelectorAll(selector)];
  const one = (selector, root = document) => root.querySelector(selector);
  const root = document.documentElement;
  const plates = all(".plate");
  const chapters = all("main > .chapter").filter((section) => section.id !== "_found");
  const query = one("#_query"), count = one("#_count"), none = one("#_none");
  const found = one("#_found"), dialog = one("#_large"), stage = one(".stage", dialog);
  const homes = new Map(plates.map((plate) => [plate, plate.parentElement]));
  const shown = () => all(".grid .plate").filter((plate) => plate.offsetParent !== null);

  // ---- light and dark ---------------------------------------------------------------------------

  const theme = one("#_theme"), night = matchMedia("(prefers-color-scheme: dark)");
  const isDark = () => (root.dataset.theme || (night.matches ? "dark" : "light")) === "dark";
  const paint = (dark = isDark()) => {
    theme.setAttribute("aria-pressed", String(isDark()));
    // A source follows the system; here it follows the page.
    for (const source of all("picture source")) source.media = dark ? "all" : "not all";
  };
  theme.addEventListener("click", () => {
    root.dataset.theme = isDark() ? "light" : "dark";
    try { localStorage.setItem("lietool-theme", root.dataset.theme); } catch { /* it lasts as long as the page */ }
    paint();
  });
  night.addEventListener("change", () => paint());
  addEventListener("beforeprint", () => paint(false));
  addEventListener("afterprint", () => paint());
  paint();

  // ---- search -----------------------------------------------------------------------------------

  // "(4.27)" is an equation, "B4.2" a figure, "4.27" either; a text's letter may stand apart: "K 9".
  const terms = (text) => text.toLowerCase()
    .replace(/\b(?:eq|eqs|equations?|fig|figs|figures?|plates?)\b\.?\s*(?=[(\dabkm])/g, "")
    .replace(/\b([km])\s*\(?(\d+)\)?(?!\.?\d)/g, "$1$2")
    .split(/\s+/).filter(Boolean);
  const scores = (plate, term) => {
    const id = plate.id.toLowerCase(), title = plate.dataset.title;
    const equations = plate.dataset.equations.split(" ");
    const bracketed = term.match(/^\((.+?)\)?$/);
    if (bracketed) return equations.includes(bracketed[1]) ? 80 : 0;
    const isNumber = /^[a-z]*\.?\d[\d.]*[a-z]?$/.test(term);
    if (id === term) return 100;
    if (isNumber) {
      if (id === `b${term}`) return 90;
      if (equations.includes(term)) return 80;
      if (id.startsWith(term) || id.startsWith(`b${term}`)) return 60;
      if (equations.some((number) => number.startsWith(term))) return 30;
      if (/^[\d.]+$/.test(term)) return 0;
    }
    if (id.startsWith(term)) return 60;
    if (` ${title}`.includes(` ${term}`)) return 50;
    if (title.includes(term)) return 40;
    return ` ${plate.dataset.words}`.includes(` ${term}`) ? 20 : plate.dataset.words.includes(term) ? 10 : 0;
  };
  const search = () => {
    const wanted = terms(query.value);
    const hits = plates.map((plate) => {
      const each = wanted.map((term) => scores(plate, term));
      return { plate, score: each.includes(0) ? 0 : each.reduce((sum, score) => sum + score, 0) };
    }).filter(({ score }) => score > 0);
    // Whoever writes a whole number means it: what only begins so is left out.
    const best = Math.max(0, ...hits.map(({ score }) => score));
    const kept = hits.filter(({ score }) => best < 80 * wanted.length || score >= 60 * wanted.length)
      .sort((a, b) => b.score - a.score).map(({ plate }) => plate);
    for (const plate of plates) homes.get(plate).append(plate);
    one(".grid", found).append(...kept);
    found.hidden = !wanted.length || !kept.length;
    none.hidden = !wanted.length || kept.length > 0;
    for (const section of chapters) section.hidden = wanted.length > 0;
    if (wanted.length) for (const link of all(".chapters a")) link.removeAttribute("aria-current");
    count.textContent = !wanted.length ? "" : kept.length === 1 ? "1 plate" : `${kept.length} plates`;
  };
  query.addEventListener("input", () => { search(); scrollTo({ top: Math.min(scrollY, top_()), behavior: "instant" }); });
  one(".search").addEventListener("submit", (event) => event.preventDefault());
  const top_ = () => one(".page").offsetTop;
  const find = (text) => { query.value = text; search(); query.focus(); scrollTo({ top: top_() }); };

  // ---- the large view ---------------------------------------------------------------------------

  const isOpen = () => dialog.open;
  let current = null;
  const open = (plate) => {
    current = plate;
    const copy = plate.cloneNode(true);
    copy.removeAttribute("id");
    one("img", copy).loading = "eager";
    one(".open", copy).removeAttribute("href");
    const text = one(".text", copy);
    text.tabIndex = -1;
    stage.replaceChildren(copy);
    stage.scrollTop = 0;
    const order = shown(), place = order.indexOf(plate);
    one(".where", dialog).textContent = place < 0 ? "" : `${place + 1} of ${order.length}`;
    one(".previous", dialog).disabled = place <= 0;
    one(".next", dialog).disabled = place === order.length - 1;
    dialog.setAttribute("aria-label", `${plate.id}: ${one("h3", plate).textContent}`);
    if (!isOpen()) dialog.showModal();
    // Here Space and the arrows up and down scroll, and Tab comes to what can be done next.
    text.focus({ preventScroll: true });
  };
  const byHash = () => {
    const plate = document.getElementById(decodeURIComponent(location.hash.slice(1)));
    if (plate && homes.has(plate)) {
      if (plate.offsetParent === null) { query.value = ""; search(); }
      open(plate);
    } else if (isOpen()) dialog.close();
  };
  const turn = (step) => {
    const order = shown(), next = order[order.indexOf(current) + step];
    if (!next) return;
    history.replaceState(null, "", `#${next.id}`);
    open(next);
  };
  addEventListener("hashchange", byHash);
  dialog.addEventListener("close", () => {
    stage.replaceChildren();
    if (location.hash.length > 1 && current && location.hash.slice(1) === current.id) history.replaceState(null, "", "#");
    if (current) one(".open", current).focus({ preventScroll: true });
    if (current) current.scrollIntoView({ block: "nearest", behavior: "instant" });
    current = null;
  });
  dialog.addEventListener("click", (event) => { if (event.target === dialog) dialog.close(); });
  one(".close", dialog).addEventListener("click", () => dialog.close());
  one(".previous", dialog).addEventListener("click", () => turn(-1));
  one(".next", dialog).addEventListener("click", () => turn(1));

  // ---- copying ----------------------------------------------------------------------------------

  const copied = async (text, host) => {
    try {
      await navigator.clipboard.writeText(text);
      return true;
    } catch { /* not allowed here, or no such thing */ }
    const area = document.createElement("textarea");
    area.value = text;
    area.setAttribute("readonly", "");
    area.style.cssText = "position:fixed;top:0;left:0;opacity:0";
    // Outside of an open dialog nothing can be selected.
    host.append(area);
    area.select();
    const done = document.execCommand("copy");
    area.remove();
    return done;
  };
  const copy = async (button) => {
    const code = one("code", button.parentElement);
    const done = await copied(code.textContent, button.parentElement);
    if (done) button.focus({ preventScroll: true });
    else getSelection().selectAllChildren(code);
    button.textContent = done ? "Copied" : "Ctrl+C";
    setTimeout(() => { button.textContent = "Copy"; }, 1600);
  };
  document.addEventListener("click", (event) => {
    const button = event.target.closest("button");
    if (button?.classList.contains("copy")) copy(button);
    if (button?.classList.contains("find")) {
      if (isOpen()) { current = null; dialog.close(); history.replaceState(null, "", "#"); }
      find(button.dataset.find);
    }
  });

  // ---- keys -------------------------------------------------------------------------------------

  const focus = (plate) => {
    if (!plate) return;
    one(".open", plate).focus({ preventScroll: true });
    plate.scrollIntoView({ block: "nearest", behavior: "instant" });
  };
  const step = (by) => {
    const order = shown(), here = order.indexOf(document.activeElement.closest?.(".plate"));
    focus(here < 0 ? order[0] : order[here + by]);
  };
  // The nearest in the next row, whatever the width of the page makes of the grid.
  const jump = (down) => {
    const here = document.activeElement.closest?.(".grid .plate");
    if (!here) return false;
    const from = here.getBoundingClientRect();
    const beyond = shown().map((plate) => ({ plate, box: plate.getBoundingClientRect() }))
      .filter(({ box }) => (down ? box.top >= from.top + 20 : box.top <= from.top - 20));
    const row = down ? Math.min(...beyond.map(({ box }) => box.top)) : Math.max(...beyond.map(({ box }) => box.top));
    const nearest = beyond.filter(({ box }) => Math.abs(box.top - row) < 20)
      .sort((a, b) => Math.abs(a.box.left - from.left) - Math.abs(b.box.left - from.left))[0];
    focus(nearest?.plate);
    return Boolean(nearest);
  };
  const moves = { ArrowRight: 1, j: 1, ArrowLeft: -1, k: -1 };
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.isComposing) return;
    const inSearch = document.activeElement === query;
    let used = true;
    if (isOpen()) {
      if (event.key in moves) turn(moves[event.key]);
      else used = false;
    } else if (inSearch) {
      if (event.key === "Enter" && query.value.trim() && shown().length) location.hash = shown()[0].id;
      else if (event.key === "ArrowDown") focus(shown()[0]);
      else if (event.key === "Escape" && query.value) { query.value = ""; search(); }
      else if (event.key === "Escape") query.blur();
      else used = false;
    } else if (event.key === "/") { query.focus(); query.select(); }
    else if (event.key === "Escape" && query.value) { query.value = ""; search(); }
    else if (event.key in moves) step(moves[event.key]);
    else if (event.key === "ArrowDown") used = jump(true);
    else if (event.key === "ArrowUp") used = jump(false);
    else used = false;
    if (used) event.preventDefault();
  });

  // ---- which chapter is on the screen -----------------------------------------------------------

  const links = new Map(all(".chapters a").map((link) => [link.hash.slice(1), link]));
  const watch = new IntersectionObserver((seen) => {
    for (const { target, isIntersecting } of seen) {
      if (!isIntersecting) continue;
      for (const link of links.values()) link.removeAttribute("aria-current");
      links.get(target.id)?.setAttribute("aria-current", "true");
    }
  }, { rootMargin: "-20% 0px -70% 0px" });
  chapters.forEach((section) => watch.observe(section));
  for (const link of links.values()) link.addEventListener("click", () => { if (query.value) { query.value = ""; search(); } });

  search();
  byHash();
})();

// ---- the list -------------------------------------------------------------------------------------

const plates = new Map(all(".plate").map((plate) => [plate.id, plate]));
const items = all(".list li"), nameOf = (item) => decodeURIComponent(one("a", item).hash.slice(1));
const query = one("#_query"), filters = all("[data-filter]");
const wide = matchMedia("(min-width: 75rem)");
let current = null, filter = "all";
const shown = () => items.filter((item) => !item.hidden);
const search = () => {
  const wanted = query.value.toLowerCase().split(/\s+/).filter(Boolean);
  for (const item of items) {
    const isKind = filter === "all" || item.dataset.kind === filter;
    item.hidden = !isKind || !wanted.every((word) => item.dataset.words.includes(word));
  }
  for (const button of filters) button.setAttribute("aria-pressed", String(button.dataset.filter === filter));
  const count = shown().length;
  one("#_none").hidden = count > 0;
  one("#_count").textContent = wanted.length ? (count === 1 ? "1 picture" : `${count} pictures`) : "";
};
const choose = (kind) => {
  filter = kind;
  search();
  if (wide.matches && shown().length && !shown().some((item) => nameOf(item) === current?.id)) open(nameOf(shown()[0]));
};
for (const button of filters) button.addEventListener("click", () => choose(button.dataset.filter));
query.addEventListener("input", search);
one(".search").addEventListener("submit", (event) => event.preventDefault());

// ---- one plate ------------------------------------------------------------------------------------

const open = (name, { focus = false } = {}) => {
  const address = `#${encodeURIComponent(name)}`;
  if (location.hash !== address) history.replaceState(null, "", address);
  const plate = plates.get(name), isNew = plate !== current;
  current = plate;
  root.classList.add("opened");
  for (const each of plates.values()) each.classList.toggle("current", each === plate);
  for (const item of items) {
    const link = one("a", item);
    if (nameOf(item) === name) {
      link.setAttribute("aria-current", "true");
      link.scrollIntoView({ block: "nearest", behavior: "instant" });
    } else link.removeAttribute("aria-current");
  }
  if (isNew) {
    viewer.show(plate);
    one("#_main").scrollTop = 0;
    scrollTo({ top: 0, behavior: "instant" });
    one("#_said").textContent = `${name}: ${one(".verdict", plate).textContent}`;
  }
  if (focus) plate.focus({ preventScroll: true });
};
const close = () => {
  const was = current;
  current = null;
  root.classList.remove("opened");
  for (const item of items) if (nameOf(item) === was?.id) one("a", item).focus();
};
const byHash = () => {
  let name = "";
  try { name = decodeURIComponent(location.hash.slice(1)); } catch { /* no name of ours */ }
  if (plates.has(name)) {
    if (!shown().some((item) => nameOf(item) === name)) { query.value = ""; choose("all"); }
    open(name, { focus: !wide.matches });
  } else if (!wide.matches) close();
};
addEventListener("hashchange", byHash);
// What goes wrong is looked at first.
const first = () => items.find((item) => item.dataset.kind === "failed") ?? items.find((item) => item.dataset.kind === "changed") ?? items[0];
wide.addEventListener("change", () => { if (wide.matches && !current && items.length) open(nameOf(first())); });
const step = (by) => {
  const order = shown(), here = order.findIndex((item) => nameOf(item) === current?.id);
  const next = order[here < 0 ? (by > 0 ? 0 : order.length - 1) : here + by];
  if (next) open(nameOf(next), { focus: !wide.matches });
};
for (const button of all(".go")) button.addEventListener("click", () => {
  if (button.dataset.blob !== undefined) viewer.place(Number(button.dataset.blob));
  else {
    const [x, y] = JSON.parse(button.dataset.go);
    viewer.go([x - 8, y - 8, x + 9, y + 9]);
  }
  viewer.stage.scrollIntoView({ block: "nearest", behavior: still.matches ? "instant" : "smooth" });
});

// ---- keys -----------------------------------------------------------------------------------------

const help = one("#_help"), single = one("#_single");
try { single.checked = localStorage.getItem("lietool-keys") !== "off"; } catch { /* on */ }
single.addEventListener("change", () => { try { localStorage.setItem("lietool-keys", single.checked ? "on" : "off"); } catch { /* not kept */ } });
one("#_keys").addEventListener("click", () => help.showModal());
for (const dialog of all("dialog")) dialog.addEventListener("click", (event) => { if (event.target === dialog) dialog.close(); });
const kinds = () => filters.filter((button) => !button.disabled).map((button) => button.dataset.filter);
const does = {
  j: () => step(1), k: () => step(-1), "/": () => { query.focus(); query.select(); },
  f: () => { const order = kinds(); choose(order[(order.indexOf(filter) + 1) % order.length]); },
  "[": () => viewer.split(-2), "]": () => viewer.split(2), ",": () => viewer.gain(-1), ".": () => viewer.gain(1),
  n: () => viewer.place(viewer.at + 1), p: () => viewer.place(viewer.at < 0 ? -1 : viewer.at - 1),
  "+": () => viewer.nearer(1), "=": () => viewer.nearer(1), "-": () => viewer.nearer(-1), 0: () => viewer.whole(),
  b: () => viewer.toggle("boxes"), l: () => viewer.toggle("loupe"), t: () => theme.click(), s: () => viewer.stage.focus(),
  a: () => current && one(".accept input", current)?.focus(), r: () => review.open(), "?": () => help.showModal(),
  1: () => viewer.choose(0), 2: () => viewer.choose(1), 3: () => viewer.choose(2), 4: () => viewer.choose(3), 5: () => viewer.choose(4),
};
const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
const escape = () => {
  if (document.activeElement.matches("input")) {
    if (document.activeElement === query && query.value) { query.value = ""; search(); } else document.activeElement.blur();
  } else if (viewer.zoomed) viewer.whole();
  else if (!wide.matches && current) location.hash = "";
};
document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || event.isComposing || one("dialog[open]")) return;
  const focus = document.activeElement, isText = focus.matches("input:not([type=range], [type=checkbox])");
  let used = true;
  if (event.key === "Escape") escape();
  else if (focus === query && event.key === "Enter" && shown().length) open(nameOf(shown()[0]), { focus: true });
  else if (isText) used = false;
  else if (focus === viewer.stage && event.key in arrows) viewer.move(...arrows[event.key].map((v) => v * (event.shiftKey ? 10 : 1)));
  else if (event.key === " " && single.checked && viewer.blinks && !focus.matches("button, a, summary, input")) viewer.space();
  else if (single.checked && Object.hasOwn(does, event.key)) does[event.key]();
  else used = false;
  if (used) event.preventDefault();
});

search();
byHash();
if (!current && wide.matches && items.length) open(nameOf(first()));

// ---- what is right as it is now -------------------------------------------------------------------

const review = (() => {
  const KEY = `lietool-review-${document.body.dataset.report}`, dialog = one("#_reviewing");
  const plates = new Map(all(".plate").map((plate) => [plate.id, plate]));
  let marks = {};
  try { marks = JSON.parse(localStorage.getItem(KEY)) ?? {}; } catch { /* kept as long as the page is open */ }
  marks = Object.fromEntries(Object.entries(marks).filter(([name, reason]) => plates.has(name) && typeof reason === "string"));
  const keep = () => { try { localStorage.setItem(KEY, JSON.stringify(marks)); } catch { /* as above */ } };
  const about = (name) => JSON.parse(plates.get(name).dataset.about);
  const marked = () => [...plates.keys()].filter((name) => name in marks);
  // As a shell reads it: within single quotes nothing has a meaning but a single quote.
  const quoted = (text) => `'${text.replaceAll("'", "'\\''")}'`;

  const command = () => {
    const takesReason = Boolean(document.body.dataset.review);
    return marked().map((name) => about(name).accept + (takesReason ? ` --reason ${quoted(marks[name])}` : "")).join("\n");
  };
  const json = () => JSON.stringify({
    review: 1,
    accept: marked().map((name) => ({ plate: name, reason: marks[name], picture: about(name).picture, numbers: about(name).numbers })),
  }, null, 2) + "\n";

  const row = (name) => {
    const item = document.createElement("li"), link = document.createElement("a"), text = document.createElement("span");
    const undo = document.createElement("button");
    link.href = `#${encodeURIComponent(name)}`;
    link.textContent = name;
    link.addEventListener("click", () => dialog.close());
    text.textContent = marks[name];
    undo.type = "button";
    undo.textContent = "Unmark";
    undo.setAttribute("aria-label", `Unmark ${name}`);
    undo.addEventListener("click", () => { set(name, null); (one(".marks button", dialog) ?? one(".close", dialog)).focus(); });
    item.append(link, text, undo);
    return item;
  };
  const paint = () => {
    const names = marked();
    one("#_review .tally").textContent = names.length;
    one("#_review").classList.toggle("some", names.length > 0);
    one(".none", dialog).hidden = names.length > 0;
    one(".some", dialog).hidden = !names.length;
    one(".marks", dialog).replaceChildren(...names.map(row));
    one("#_each").textContent = command();
    one("#_from").textContent = document.body.dataset.review;
    one(".from", dialog).hidden = !document.body.dataset.review;
    for (const [name, plate] of plates) {
      const form = one(".accept", plate);
      if (!form) continue;
      const on = name in marks, input = one("input", form);
      form.classList.toggle("on", on);
      if (on && document.activeElement !== input) input.value = marks[name];
      one("button", form).textContent = on ? "Unmark" : "Mark";
      one(".marked", form).textContent = on ? "Marked as right. It is accepted once the review is applied." : "";
    }
    for (const link of all(".list a")) link.classList.toggle("marked", decodeURIComponent(link.hash.slice(1)) in marks);
  };
  const set = (name, reason) => {
    if (reason === null) delete marks[name];
    else marks[name] = reason;
    keep();
    paint();
  };

  for (const [name, plate] of plates) {
    const form = one(".accept", plate);
    if (!form) continue;
    const input = one("input", form);
    input.addEventListener("input", () => {
      input.setCustomValidity("");
      // What was marked with another reason is not marked with this one.
      if (name in marks) set(name, null);
    });
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      const reason = input.value.trim().split(/\s+/).join(" ");
      if (name in marks) { set(name, null); input.focus(); return; }
      if (!reason) {
        input.setCustomValidity("Say why it is right: the reason is kept with the golden.");
        input.reportValidity();
        return;
      }
      set(name, reason);
      one("button", form).focus();
    });
  }
  one("#_download").addEventListener("click", () => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([json()], { type: "application/json" }));
    link.download = "review.json";
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  });
  one("#_review").addEventListener("click", () => open());
  const open = () => { paint(); dialog.showModal(); };
  paint();
  return { open, json };
})();

// ---- copying --------------------------------------------------------------------------------------

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
for (const button of all(".copy")) button.addEventListener("click", async () => {
  const code = one("code", button.parentElement), done = await copied(code.textContent, button.parentElement);
  if (done) button.focus({ preventScroll: true });
  else getSelection().selectAllChildren(code);
  button.textContent = done ? "Copied" : "Ctrl+C";
  setTimeout(() => { button.textContent = "Copy"; }, 1600);
});

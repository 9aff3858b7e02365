"use strict";

document.querySelectorAll(".needs-script").forEach((element) => { element.hidden = false; });

// The table of all cases: sorted by clicks on headings, filtered by words.
{
  const table = document.getElementById("cases-table");
  const body = table.tBodies[0];
  const headings = [...table.tHead.rows[0].cells];
  const rows = [...body.rows];
  const names = rows.map((row) => [...row.cells].slice(0, 4).map((cell) => cell.textContent).join(" ").toLowerCase());
  const byName = new Intl.Collator("en", { numeric: true }).compare;
  const filter = document.getElementById("filter");
  const count = document.getElementById("count");

  const compare = (a, b, isNumber, sign) => {
    if (!isNumber) return sign * byName(a, b);
    const [x, y] = [parseFloat(a), parseFloat(b)];
    // Rows without a value are last in both orders.
    if (isNaN(x) || isNaN(y)) return isNaN(x) - isNaN(y);
    return sign * (x - y);
  };

  const sort = (column) => {
    const heading = headings[column];
    const isNumber = heading.classList.contains("n");
    // The worst numbers come first; a third click restores the original order.
    const orders = isNumber ? ["descending", "ascending"] : ["ascending", "descending"];
    const order = orders[orders.indexOf(heading.getAttribute("aria-sort")) + 1];
    headings.forEach((other) => other.removeAttribute("aria-sort"));
    if (order) heading.setAttribute("aria-sort", order);
    const sign = order === "ascending" ? 1 : -1;
    const text = (row) => row.cells[column].textContent;
    const sorted = order ? [...rows].sort((a, b) => compare(text(a), text(b), isNumber, sign)) : rows;
    body.append(...sorted);
  };

  const show = () => {
    const words = filter.value.toLowerCase().split(/\s+/);
    const shown = rows.filter((row, index) => {
      row.hidden = !words.every((word) => names[index].includes(word));
      return !row.hidden;
    });
    count.textContent = `${shown.length} of ${rows.length}`;
  };

  headings.forEach((heading, column) => heading.firstElementChild.addEventListener("click", () => sort(column)));
  filter.addEventListener("input", show);
  // Browsers may restore the filter of the last visit.
  show();
}

// The dialog: one image of a case at a time, all in the same position.
{
  const dialog = document.getElementById("large");
  const stage = dialog.querySelector(".stage");
  const name = document.getElementById("large-name");
  let captions = [];
  let current = 0;

  const flip = (step) => {
    const count = captions.length;
    current = (current + step + count) % count;
    [...stage.children].forEach((image, index) => image.classList.toggle("out", index !== current));
    name.textContent = `${current + 1} of ${count}: ${captions[current]}`;
  };

  const open = (link) => {
    const links = [...link.closest(".images").querySelectorAll("a")];
    captions = links.map((other) => other.firstElementChild.alt);
    // All are loaded at once, so that flipping does not flicker.
    stage.replaceChildren(...links.map((other) => {
      const image = new Image();
      image.src = other.href;
      image.alt = other.firstElementChild.alt;
      return image;
    }));
    current = links.indexOf(link);
    flip(0);
    dialog.showModal();
  };

  document.addEventListener("click", (event) => {
    const link = event.target.closest(".images a");
    if (!link || event.ctrlKey || event.metaKey || event.shiftKey) return;
    event.preventDefault();
    open(link);
  });
  stage.addEventListener("click", () => flip(1));
  dialog.addEventListener("click", (event) => {
    const step = event.target.closest("button")?.dataset.step;
    if (step === "0") dialog.close();
    else if (step) flip(Number(step));
  });
  dialog.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!step) return;
    event.preventDefault();
    flip(step);
  });
}

// Hides the rows, and their pictures, that do not have every word of the search field.
const field = document.querySelector("input[type=search]"), told = document.querySelector(".search output");
const rows = [...document.querySelectorAll("tbody tr")], figures = document.querySelectorAll("figure");
const texts = rows.map((row) => row.textContent.toLowerCase());
const filter = () => {
  const words = field.value.toLowerCase().split(/\s+/);
  let shown = 0;
  rows.forEach((row, i) => {
    row.hidden = !words.every((word) => texts[i].includes(word));
    if (figures[i]) figures[i].hidden = row.hidden;
    shown += !row.hidden;
  });
  told.textContent = `${shown} of ${rows.length}`;
};
field.addEventListener("input", filter);
filter();

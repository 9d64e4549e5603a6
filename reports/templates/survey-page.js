// What every part of the survey page uses: the data, the spelling of figures, the making of elements.
// survey_page.py puts these files into one strict block, so each name here is seen by the parts after.

const data = JSON.parse(document.getElementById("survey-data").textContent);
const { clusters, strings } = data;
const byId = (id) => document.getElementById(id);
const number = (value) => value.toLocaleString("en-GB");
const counted = (value, noun) => `${number(value)} ${noun}${value === 1 ? "" : "s"}`;
const share = (part) => {
  const tenths = Math.floor((1000 * part) / data.files);
  return tenths >= 1000 ? "100 %" : `${(tenths / 10).toFixed(1)} %`;
};

/** An element with a class and children; texts become text nodes, null is left out. */
function el(tag, className, ...children) {
  const element = document.createElement(tag);
  if (className) element.className = className;
  element.append(...children.flat().filter((child) => child !== null));
  return element;
}
function button(label, action, title = "") {
  const element = el("button", "", label);
  element.type = "button";
  if (title) element.title = title;
  element.addEventListener("click", () => action(element));
  return element;
}

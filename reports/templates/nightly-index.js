// Opens the last nightly run, or warns if it was too long ago.

const hours = (Date.now() - Date.parse(page.made)) / 3600000;
const told = document.getElementById("told");
if (hours < -24) told.textContent = "This run is dated in the future: the clock of its machine is wrong.";
else if (hours > 48) told.textContent = `There has been no nightly run for ${Math.floor(hours / 24)} days.`;
else location.replace(document.getElementById("last").href);

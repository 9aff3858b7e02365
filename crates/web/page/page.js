// The demo page: a viewer, and controls for everything that it can choose.
import init, { Model, Viewer } from "./shadowgraph_web.js";
import { createSettings } from "./settings.js";
import { attachCamera } from "./camera.js";
import { dropped, picked } from "./files.js";

const $ = id => document.getElementById(id);

let viewer;
let playing = true;
let time = 0;
let last = 0;
// Whether the image is older than a choice.
let stale = true;
const changed = () => { stale = true; };

function say(text, isError = false) {
  $("status").textContent = text;
  $("status").classList.toggle("error", isError);
}

/** Runs a choice of the user, and returns its error, or an empty text. */
function tried(work) {
  try {
    work();
    changed();
    return "";
  } catch (error) {
    return error.message;
  }
}

/** Runs a choice of the user; an error is shown in `place`, or over the view, until a choice succeeds. */
function attempt(work, place) {
  const error = tried(work);
  if (place) place.textContent = error;
  else if (error || $("status").classList.contains("error")) say(error, error !== "");
  return error === "";
}

// Models.

function show(model) {
  viewer.show(model);
  const notes = model.notes();
  model.free();
  $("notes").hidden = notes.length === 0;
  $("notes").querySelector("ul").replaceChildren(...notes.map(note => item(note)));
  time = 0;
  $("time").max = viewer.duration || 1;
  for (const id of ["time", "play"]) $(id).disabled = viewer.duration === 0;
  changed();
}

function item(text) {
  const element = document.createElement("li");
  element.textContent = text;
  return element;
}

async function open(files) {
  say("Loading …");
  try {
    const { name, bytes, others } = await files;
    // Lets the browser show that it is loading.
    await new Promise(resolve => setTimeout(resolve));
    show(new Model(name, bytes, others));
    say("");
  } catch (error) {
    say(error.message, true);
  }
}

async function download(url) {
  $("progress").hidden = false;
  try {
    show(await Model.fetch(url, (part, name) => {
      $("progress").value = part;
      say(`Loading ${name} …`);
    }));
    say("");
  } catch (error) {
    say(error.message, true);
  }
  $("progress").hidden = true;
}

// Techniques.

function option(name, summary, group) {
  const element = new Option(name, name);
  element.title = summary;
  group.append(element);
}

function chooseTechnique() {
  const chosen = ["technique", "modifier"].map(id => $(id).selectedOptions[0]);
  $("technique-hint").textContent = chosen.map(({ title }) => title).filter(Boolean).join("; ");
  attempt(() => { viewer.technique = chosen.map(({ value }) => value).join(""); });
  showNames();
}

function compare() {
  const name = $("compared").value;
  attempt(() => { viewer.compared = name || undefined; });
  for (const id of ["divider", "split"]) $(id).hidden = !name;
  showNames();
}

function split() {
  viewer.split($("split").valueAsNumber);
  $("divider").style.left = `${$("split").valueAsNumber * 100}%`;
}

function dragDivider(event) {
  if (!$("divider").hasPointerCapture(event.pointerId)) return;
  const { left, width } = $("stage").getBoundingClientRect();
  $("split").value = (event.clientX - left) / width;
  split();
}

function showNames() {
  $("left-name").textContent = viewer.technique;
  $("right-name").textContent = viewer.compared ?? "";
}

function fillTechniques() {
  const { techniques, modifiers } = JSON.parse(Viewer.techniques());
  $("compared").append(new Option("no comparison", ""));
  $("modifier").append(new Option("alone", ""));
  for (const { name, summary } of techniques) option(name, summary, $("technique"));
  for (const { name, summary } of modifiers) option(`+${name}`, summary, $("modifier"));
  for (const added of ["", ...modifiers.map(({ name }) => `+${name}`)]) {
    const group = document.createElement("optgroup");
    group.label = added || "alone";
    for (const { name, summary } of techniques) option(name + added, summary, group);
    $("compared").append(group);
  }
  $("technique").value = viewer.technique;
  $("technique-hint").textContent = $("technique").selectedOptions[0].title;
}

// Pipelines.

// The text that is none of the built-in ones.
let edited = "";

function keepEdited() {
  if ($("text").value === Viewer.pipelineText($("pipelines").value)) return;
  edited = $("text").value;
  $("edited").hidden = false;
  $("pipelines").value = "";
}

/** Shows the numbers of lines, and marks the one that an error `name:line:column: …` names. */
function showLines(marked = 0) {
  const count = $("text").value.split("\n").length;
  const lines = Array.from({ length: count }, (_, index) => {
    const element = document.createElement(index + 1 === marked ? "mark" : "span");
    element.textContent = index + 1;
    return [element, "\n"];
  });
  $("lines").replaceChildren(...lines.flat());
  $("lines").scrollTop = $("text").scrollTop;
}

function applyPipeline() {
  let warnings = [];
  const isValid = attempt(() => { warnings = viewer.setPipelineText("pipeline", $("text").value); }, $("pipeline-error"));
  if (isValid) $("pipeline-error").textContent = warnings.join("\n");
  const line = Number(/^pipeline:(\d+):/.exec($("pipeline-error").textContent)?.[1] ?? 0);
  if (line > 0) {
    const height = $("text").scrollHeight / $("text").value.split("\n").length;
    $("text").scrollTop = (line - 3) * height;
  }
  keepEdited();
  showLines(line);
}

function fillPipelines() {
  for (const name of Viewer.pipelines()) $("pipelines").append(new Option(name, name));
  $("pipelines").value = viewer.pipeline;
  const load = () => {
    $("text").value = Viewer.pipelineText($("pipelines").value) ?? edited;
    $("text").scrollTop = 0;
    showLines();
  };
  $("pipelines").onchange = () => {
    load();
    if ($("pipelines").value) attempt(() => { viewer.pipeline = $("pipelines").value; }, $("pipeline-error"));
    else applyPipeline();
  };
  load();
}

// Passes and the graph.

function showTimes() {
  const times = JSON.parse(viewer.times());
  const number = value => value === null || value === undefined ? "–" : value.toFixed(2);
  const sum = times.reduce((total, { gpu_ms }) => total + (gpu_ms ?? 0), 0);
  $("total").textContent = times.length === 0 ? "Measuring …"
    : sum > 0 ? `${times.length} passes, ${sum.toFixed(1)} ms on the GPU` : `${times.length} passes; this browser does not measure their times`;
  $("times").replaceChildren(...times.map(({ pass, gpu_ms, cpu_ms, draws }) => {
    const row = document.createElement("tr");
    for (const text of [pass, number(gpu_ms), number(cpu_ms), draws ?? ""]) row.insertCell().textContent = text;
    return row;
  }));
}

let shownGraph;
function showGraph() {
  const page = viewer.graphPage();
  if (shownGraph) URL.revokeObjectURL(shownGraph);
  shownGraph = URL.createObjectURL(new Blob([page], { type: "text/html" }));
  $("frame").src = shownGraph;
  $("save").href = shownGraph;
}

function select(tab) {
  for (const button of $("tabs").children) {
    const isShown = button.dataset.tab === tab;
    button.ariaSelected = isShown;
    button.tabIndex = isShown ? 0 : -1;
    $(button.dataset.tab).classList.toggle("shown", isShown);
  }
  viewer.measure(tab === "passes" || tab === "graph");
  if (tab === "graph") showGraph();
  if (tab === "passes") showTimes();
  changed();
}

// Frames.

async function recover(why) {
  say(`The device is lost (${why}); opening another one …`, true);
  for (let attempts = 0; ; attempts++) {
    try {
      await viewer.recover();
      say("");
      return changed();
    } catch (error) {
      if (attempts === 20) throw error;
      await new Promise(resolve => setTimeout(resolve, 500));
    }
  }
}

async function frame(now) {
  try {
    const lost = viewer.lost();
    if (lost) await recover(lost);
    const seconds = Math.min((now - last) / 1000, 0.1);
    last = now;
    const moves = playing && viewer.duration > 0 && !document.hidden;
    if (moves) {
      time = (time + seconds) % viewer.duration;
      $("time").value = time;
    }
    $("seconds").textContent = viewer.duration > 0 ? `${time.toFixed(1)} s` : "none";
    if (moves || stale) {
      stale = false;
      viewer.draw(time);
      await viewer.finished();
      if ($("passes").classList.contains("shown")) {
        showTimes();
        // The times of a still image arrive with the next one.
        if (!moves && $("times").rows.length === 0) changed();
      }
    }
    const error = viewer.takeError();
    if (error) say(error, true);
  } catch (error) {
    say(error.message ?? String(error), true);
  }
  requestAnimationFrame(frame);
}

function listen() {
  attachCamera($("canvas"), viewer, changed);
  new ResizeObserver(() => {
    const scale = Math.min(devicePixelRatio, 2);
    viewer.resize(Math.round($("canvas").clientWidth * scale), Math.round($("canvas").clientHeight * scale));
    changed();
  }).observe($("canvas"));
  $("files").onchange = () => open(picked($("files").files));
  $("demo").onclick = () => attempt(() => show(Model.demo()));
  $("technique").onchange = $("modifier").onchange = chooseTechnique;
  $("compared").onchange = compare;
  $("split").oninput = split;
  $("divider").onpointerdown = event => $("divider").setPointerCapture(event.pointerId);
  $("divider").onpointermove = dragDivider;
  $("play").onclick = () => {
    playing = !playing;
    $("play").textContent = playing ? "Pause" : "Play";
  };
  $("time").oninput = () => {
    time = $("time").valueAsNumber;
    changed();
  };
  $("apply").onclick = applyPipeline;
  $("text").oninput = () => {
    keepEdited();
    showLines();
  };
  $("text").onscroll = () => { $("lines").scrollTop = $("text").scrollTop; };
  $("text").onkeydown = event => {
    if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) applyPipeline();
  };
  $("update").onclick = showGraph;
  $("tabs").onclick = event => event.target.dataset.tab && select(event.target.dataset.tab);
  $("tabs").onkeydown = event => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    const tabs = [...$("tabs").children];
    if (!step) return;
    const next = tabs[(tabs.indexOf(event.target) + step + tabs.length) % tabs.length];
    next.focus();
    select(next.dataset.tab);
  };
  for (const name of ["dragenter", "dragover"]) {
    addEventListener(name, event => {
      event.preventDefault();
      $("drop").hidden = false;
    });
  }
  addEventListener("dragleave", event => { $("drop").hidden = event.relatedTarget === null; });
  addEventListener("drop", event => {
    event.preventDefault();
    $("drop").hidden = true;
    open(dropped(event.dataTransfer));
  });
}

async function start() {
  await init();
  viewer = await Viewer.create($("canvas"));
  fillTechniques();
  fillPipelines();
  createSettings(JSON.parse(Viewer.settingsSchema()), json => tried(() => viewer.setSettings(json)));
  $("lacks").replaceChildren(...viewer.lacks().map(text => item(text)));
  listen();
  select("scene");
  showNames();
  show(Model.demo());
  say("");
  requestAnimationFrame(frame);
  const model = new URLSearchParams(location.search).get("model");
  if (model) await download(model);
  // For the console of the browser.
  globalThis.viewer = viewer;
}

start().catch(error => say(error.message ?? String(error), true));

// Fields for every setting of a JSON Schema. What differs from its default is handed over as JSON.

/**
 * Fills `#fields` with the settings of a schema. `apply` gets JSON and returns an error, or an empty text. A value that is refused is left
 * out until it fits.
 */
export function createSettings(schema, apply) {
  const root = document.getElementById("fields");
  const fields = [];
  const without = refused => {
    const changes = {};
    for (const field of fields.filter(field => !refused.includes(field) && field.isChanged())) {
      put(changes, field.path, field.value());
    }
    return JSON.stringify(changes);
  };
  const send = changed => {
    for (const field of fields) field.element.classList.toggle("changed", field.isChanged());
    const refused = fields.filter(field => field !== changed && field.error.textContent !== "");
    let error = apply(without([]));
    if (error === "") {
      for (const field of refused) field.error.textContent = "";
    } else if (refused.length > 0) {
      error = apply(without(refused));
    }
    if (changed) changed.error.textContent = error;
  };
  addFields(root, schema, [], fields, send);
  document.getElementById("reset").onclick = () => {
    for (const field of fields) {
      field.reset();
      field.error.textContent = "";
    }
    send();
  };
  const filter = document.getElementById("filter");
  filter.oninput = () => {
    const words = plain(filter.value).split(" ").filter(Boolean);
    for (const { element, path } of fields) {
      const text = plain(`${path.join(" ")} ${element.textContent}`);
      element.hidden = !words.every(word => text.includes(word));
    }
    for (const group of root.querySelectorAll("details")) {
      group.hidden = !group.querySelector(".field:not([hidden])");
      group.open = words.length > 0 && !group.hidden;
    }
    document.getElementById("none-found").hidden = fields.some(({ element }) => !element.hidden);
  };
}

/** Returns a text with `cascades.map_size_px` as words. */
const plain = text => text.toLowerCase().replaceAll(/[._]/g, " ");

function put(object, path, value) {
  for (const name of path.slice(0, -1)) object = object[name] ??= {};
  object[path.at(-1)] = value;
}

function addFields(parent, schema, path, fields, send) {
  for (const [name, setting] of Object.entries(schema.properties)) {
    if (setting.properties) {
      const group = document.createElement("details");
      const title = document.createElement("summary");
      title.textContent = name;
      group.append(title);
      parent.append(group);
      addFields(group, setting, [...path, name], fields, send);
    } else {
      parent.append(addField(name, setting, [...path, name], fields, send));
    }
  }
}

function addField(name, schema, path, fields, send) {
  const element = document.createElement("div");
  element.className = "field";
  const input = inputOf(schema);
  const label = document.createElement("label");
  label.textContent = name;
  label.htmlFor = input.element.id = `setting-${path.join("-")}`;
  const about = document.createElement("p");
  const forms = input.element.type === "text" ? shape(schema) : range(schema);
  about.textContent = [schema.description, forms].filter(Boolean).join("; ");
  const error = document.createElement("p");
  error.className = "error";
  error.role = "alert";
  element.append(label, input.element, about, error);
  // Without a distance, shadows reach as far as the visible scene.
  const isAutomatic = path.join() === "distance_m";
  if (isAutomatic) {
    input.element.placeholder = "automatic";
    about.textContent += "; empty: as far as the visible scene reaches";
  }
  const reset = () => input.set(isAutomatic ? undefined : schema.default);
  reset();
  const initial = JSON.stringify(input.value());
  const isChanged = () => JSON.stringify(input.value()) !== initial;
  const field = { element, path, error, value: input.value, isChanged, reset };
  input.element.onchange = () => {
    // An empty field has its default.
    if (input.element.value === "" && !input.element.validity.badInput) reset();
    send(field);
  };
  fields.push(field);
  return element;
}

function range({ minimum, maximum }) {
  return minimum === undefined ? "" : `${minimum} to ${maximum}`;
}

/** Returns what values of a schema look like as JSON. */
function shape(schema) {
  const { const: value, enum: choices, anyOf, properties, type, items } = schema;
  if (value !== undefined) return JSON.stringify(value);
  if (choices) return choices.map(choice => JSON.stringify(choice)).join(" or ");
  if (anyOf) return anyOf.map(shape).join(" or ");
  if (items) return `[${shape(items)}, …]`;
  if (properties) return `{${Object.entries(properties).map(([name, inner]) => `"${name}": ${shape(inner)}`).join(", ")}}`;
  return range(schema) || (type ?? "");
}

/** Returns a form element for the values of a schema, with functions that set and return its value. */
function inputOf(schema) {
  const create = properties => Object.assign(document.createElement("input"), properties);
  const choices = schema.enum ?? constants(schema);
  if (choices) {
    const element = document.createElement("select");
    for (const value of choices) element.append(new Option(text(value), JSON.stringify(value)));
    return {
      element,
      set: value => { element.value = JSON.stringify(value); },
      value: () => JSON.parse(element.value),
    };
  }
  if (schema.type === "boolean") {
    const element = create({ type: "checkbox" });
    return { element, set: value => { element.checked = value; }, value: () => element.checked };
  }
  if (schema.type === "number" || schema.type === "integer") {
    const step = schema.type === "integer" ? 1 : "any";
    const element = create({ type: "number", min: schema.minimum, max: schema.maximum, step });
    return {
      element,
      set: value => { element.value = value ?? ""; },
      value: () => element.validity.badInput ? "" : element.value === "" ? undefined : element.valueAsNumber,
    };
  }
  // Lists and values with several shapes are written as JSON; what is no JSON is handed over as text, and refused.
  const element = create({ type: "text", spellcheck: false });
  return {
    element,
    set: value => { element.value = JSON.stringify(value) ?? ""; },
    value: () => {
      try {
        return element.value === "" ? undefined : JSON.parse(element.value);
      } catch {
        return element.value;
      }
    },
  };
}

/** Returns the values of a schema that allows only constants. */
function constants({ anyOf, default: initial }) {
  if (!anyOf?.every(({ const: value, type }) => value !== undefined || type === "null")) return undefined;
  const values = anyOf.map(({ const: value }) => value ?? null);
  return values.some(value => JSON.stringify(value) === JSON.stringify(initial)) ? values : undefined;
}

const text = value => typeof value === "string" ? value : JSON.stringify(value);

// The elements of the page, found by their ids and made.

/** The element with this id; viewer.html has it. */
export function byId<T extends HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`viewer.html has no element '${id}'`);
  return found as T;
}

/** A new element with properties and children. */
export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  properties: Partial<HTMLElementTagNameMap[K]> = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  Object.assign(element, properties);
  element.append(...children);
  return element;
}

/** Rows of a list of terms, `dt` and `dd`. */
export function terms(rows: [string, string][]): Node[] {
  return rows.flatMap(([name, value]) => [make("dt", { textContent: name }), make("dd", { textContent: value })]);
}

/** Whether keys belong to what has the focus: a field in which one types. */
export function isTyping(event: KeyboardEvent): boolean {
  const target = event.target;
  if (target instanceof HTMLSelectElement || target instanceof HTMLTextAreaElement) return true;
  return target instanceof HTMLInputElement && target.type !== "checkbox" && target.type !== "radio" && target.type !== "range";
}

/** Says instead of a picture why there is none. */
export function fail(title: string, what: string): void {
  const message = byId("message");
  message.replaceChildren(make("h1", { textContent: title }), make("p", { textContent: what }));
  message.hidden = false;
  byId("loading").hidden = true;
}

// What is written into the page itself: packed parts in base64, and what the page is about.

import { Damaged, type Part, unpack } from "./part";

/** What kind of page this is. */
export interface About {
  /** It asks its server for what it shows. */
  live?: boolean;
  /** It shows two solutions. */
  compared?: {
    /** After, before. */
    names: [string, string];
    /** Whether values of elements can be compared one by one. */
    same_elements: boolean;
  };
}

/** What the page is about; nothing if it is not whole. */
export function about(): About {
  const text = document.getElementById("about")?.textContent;
  if (!text) throw new Damaged("nothing was put into it; isolux view makes a page that shows a solution");
  return JSON.parse(text);
}

/** The part of this name, if the page has one. The text is dropped, for it is long. */
export async function embedded<H>(id: string): Promise<Part<H> | undefined> {
  const script = document.getElementById(id);
  if (!script) return undefined;
  const text = script.textContent ?? "";
  script.remove();
  return unpack(fromBase64(text));
}

/** The bytes that a text in base64 stands for. Throws Damaged if it is none. */
export function fromBase64(text: string): Uint8Array<ArrayBuffer> {
  // A short text at a time: what is decoded is a text again.
  const CHUNK = 1 << 20;
  const bytes = new Uint8Array(Math.floor((text.length * 3) / 4));
  let length = 0;
  try {
    for (let start = 0; start < text.length; start += CHUNK) {
      const decoded = atob(text.slice(start, start + CHUNK));
      for (let k = 0; k < decoded.length; k++) bytes[length++] = decoded.charCodeAt(k);
    }
  } catch {
    throw new Damaged("it is no base64");
  }
  return bytes.subarray(0, length);
}

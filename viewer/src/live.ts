// A solve that runs: the page asks its server how far it is, and takes new light as it comes.

import { Light, type LightHeader } from "./light";
import { byId } from "./page";
import { type Part, unpack } from "./part";
import { Surfaces, type SurfacesHeader } from "./surfaces";
import type { Shown } from "./viewer";

/** Milliseconds between two questions. */
const EVERY = 400;

/** What the server says of the solve. */
interface Progress {
  /** Counts the lights; 0 before the first. */
  revision: number;
  finished: boolean;
  words: string;
}

async function ask(what: string): Promise<Response> {
  const answer = await fetch(what, { cache: "no-store" });
  if (!answer.ok) throw new Error(`the server answered ${answer.status}`);
  return answer;
}

async function part<H>(what: string): Promise<Part<H>> {
  return unpack<H>(new Uint8Array(await (await ask(what)).arrayBuffer()));
}

const progress = async (): Promise<Progress> => (await ask("/revision")).json();
const pause = () => new Promise((done) => setTimeout(done, EVERY));

export class Live {
  private revision = 0;

  /** The first light, when it is there. */
  async first(): Promise<Shown> {
    for (;;) {
      const { revision, words } = await progress();
      this.say(words || "waiting for the first light", false);
      if (revision > 0) {
        this.revision = revision;
        return { surfaces: new Surfaces(await part<SurfacesHeader>("/surfaces")), light: new Light(await part<LightHeader>("/light")) };
      }
      await pause();
    }
  }

  /** Gives every new light to `show` until the solve is done, or its server is gone. */
  async follow(show: (light: Light) => void): Promise<void> {
    for (;;) {
      const news = await this.news().catch(() => undefined);
      if (!news) {
        this.say("the solve has ended; this is the last light it sent", true);
        return;
      }
      if (news.light) show(news.light);
      this.say(news.words, news.finished);
      if (news.finished) return;
      await pause();
    }
  }

  /** How far the solve is, and its light if it is new. */
  private async news(): Promise<Progress & { light?: Light }> {
    const now = await progress();
    if (now.revision === this.revision) return now;
    const light = new Light(await part<LightHeader>("/light"));
    this.revision = now.revision;
    return { ...now, light };
  }

  private say(words: string, finished: boolean): void {
    const state = byId("live");
    state.hidden = false;
    state.textContent = words;
    state.classList.toggle("finished", finished);
    state.dataset.revision = String(this.revision);
  }
}

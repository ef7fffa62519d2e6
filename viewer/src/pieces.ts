// Long work in pieces, done while the page has nothing better to do.

/** Work that pauses again and again; what it finds on its way is handed out in between. */
export type Pieces<T, Found = undefined> = Generator<Found | undefined, T, void>;

/** Rounds of a loop between two pauses: a millisecond or so. */
export const PIECE = 1 << 13;
/** Milliseconds in a row where a browser cannot say whether it is idle, and after how many it has to be in all others. */
const [SLICE, LONGEST] = [6, 100];

/** Does the work at once. */
export function finish<T>(work: Pieces<T>): T {
  for (;;) {
    const { done, value } = work.next();
    if (done) return value;
  }
}

/** Does the work while the page is idle. */
export function whenIdle(work: Pieces<void>): Promise<void> {
  return new Promise((done) => {
    const until = (end: () => number) => {
      do {
        if (work.next().done) return done();
      } while (end() > 0);
      next();
    };
    const next = () => {
      // Safari has no requestIdleCallback in versions that are in use.
      if (typeof requestIdleCallback === "function") requestIdleCallback((idle) => until(() => idle.timeRemaining()), { timeout: LONGEST });
      else {
        const end = performance.now() + SLICE;
        setTimeout(() => until(() => end - performance.now()));
      }
    };
    next();
  });
}

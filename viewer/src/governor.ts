// The governor of the frame rate: while the camera moves, which step down from the whole picture is drawn, as frames take longer than those of
// 30 a second, or leave room. It knows times of frames and nothing else.

/** Milliseconds of a frame. */
const FRAME = 1000 / 30;
/** A frame that took longer is slow (clocks of browsers are no better); one that took less leaves room for more. */
const [SLOW, ROOMY] = [1.15 * FRAME, 0.75 * FRAME];
/** So many slow frames in a row are no accident. */
const IN_A_ROW = 2;
/** Frames that are on their way when the step changes, whose times tell nothing of the next one. */
const ON_THE_WAY = 2;
/** Frames with room before more is tried: at first, and at most, after it was tried in vain. */
const [PATIENCE, MOST_PATIENCE] = [30, 2000];

export class Governor {
  /** Steps down: 0 is the whole picture. */
  step: number;
  private slow = 0;
  private roomy = 0;
  private skipped = ON_THE_WAY;
  private patience = PATIENCE;
  private isTrial = false;

  /** Of so many steps, from `first` on. */
  constructor(private readonly steps: number, first = 0) {
    this.step = Math.min(first, steps - 1);
  }

  /** A frame took so many milliseconds. */
  took(ms: number): void {
    if (this.skipped-- > 0) return;
    this.slow = ms > SLOW ? this.slow + 1 : 0;
    if (ms < ROOMY) this.roomy++;
    if (this.slow >= IN_A_ROW) {
      // Steps are chosen so that each takes about half as long.
      this.go(this.step + Math.max(1, Math.floor(Math.log2(ms / FRAME))), this.isTrial ? 2 * this.patience : this.patience, false);
    } else if (this.roomy >= this.patience) {
      // What was tried has held as long as it took to try it.
      this.go(this.step - 1, this.isTrial ? PATIENCE : this.patience, true);
    }
  }

  /** Something else was drawn in between, which may be on its way still. */
  pause(): void {
    this.skipped = ON_THE_WAY;
    this.slow = 0;
  }

  private go(to: number, patience: number, isTrial: boolean): void {
    const step = Math.min(Math.max(to, 0), this.steps - 1);
    if (step !== this.step) this.skipped = ON_THE_WAY;
    this.step = step;
    this.patience = Math.min(patience, MOST_PATIENCE);
    this.isTrial = isTrial;
    this.slow = this.roomy = 0;
  }
}

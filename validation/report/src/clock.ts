// The time that the 3D view and the plots of a scene show together.

/** Who moved it: that one need not be told. */
export type ClockUser = object;

export class Clock {
  private now = 0;
  private readonly listeners = new Map<ClockUser, (t: number) => void>();

  constructor(readonly end: number) {}

  get time(): number {
    return this.now;
  }

  /** Calls the listeners but the mover's own; a time outside [0, end] stands at the nearer end. */
  move(t: number, by: ClockUser): void {
    this.now = Math.min(this.end, Math.max(0, t));
    for (const [user, listener] of this.listeners) if (user !== by) listener(this.now);
  }

  listen(user: ClockUser, listener: (t: number) => void): void {
    this.listeners.set(user, listener);
  }

  forget(user: ClockUser): void {
    this.listeners.delete(user);
  }
}

// Keys of the whole page. What is typed into a field, or with a modifier, is left alone.

/** Keys that scroll the page, and press or move what has the focus, where nothing is played. */
const kPlayback = [' ', 'Home'];

/** Does the element with the focus use this key itself? */
function uses(element: EventTarget | null, key: string): boolean {
  if (element instanceof HTMLInputElement && element.type === 'range') {
    return key.startsWith('Arrow');
  }
  if (element instanceof HTMLInputElement && element.type !== 'checkbox') return true;
  if (element instanceof HTMLSelectElement) return true;
  return key === ' ' && (element instanceof HTMLInputElement || element instanceof HTMLButtonElement);
}

/** @param canPlay whether the keys of the playback mean anything now */
export function onKeys(canPlay: () => boolean, actions: Record<string, () => void>): void {
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (uses(event.target, event.key)) {
      if (event.key === 'Escape') (event.target as HTMLElement).blur();
      return;
    }
    const action = actions[event.key];
    if (action === undefined || (kPlayback.includes(event.key) && !canPlay())) return;
    event.preventDefault();
    action();
  });
}

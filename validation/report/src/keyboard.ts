// Keys of the whole page. What is typed into a field, or with a modifier, is left alone.

export function onKeys(actions: Record<string, () => void>): void {
  document.addEventListener('keydown', (event) => {
    const isTyping = event.target instanceof HTMLInputElement;
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (isTyping) {
      if (event.key === 'Escape') (event.target as HTMLInputElement).blur();
      return;
    }
    const action = actions[event.key];
    if (action === undefined) return;
    event.preventDefault();
    action();
  });
}

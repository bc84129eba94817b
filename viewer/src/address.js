// What is seen, in the address of the page: to come back to it, or to send it.

/** The state that the address holds; nothing where it is damaged. */
export function fromAddress() {
  const found = {};
  for (const [key, value] of new URLSearchParams(location.hash.slice(1))) {
    try {
      found[key] = JSON.parse(value);
    } catch {
      // A part that somebody has cut is left out.
    }
  }
  return found;
}

/** Puts a state into the address, without a new entry in the history. */
export function toAddress(state) {
  const parts = new URLSearchParams();
  for (const [key, value] of Object.entries(state)) if (value !== undefined && value !== null) parts.set(key, JSON.stringify(value));
  history.replaceState(null, '', `#${parts}`);
}

// Boxes to tick: what the 3-D view shows.

// Each of `switches` has a name, whether it is on, and what it does.
export function makeSwitches(after, switches, redraw) {
  const form = document.createElement('form');
  form.className = 'switches';
  for (const { name, shown, set } of switches) {
    const label = document.createElement('label');
    const box = document.createElement('input');
    const text = document.createElement('bdi');
    box.type = 'checkbox';
    box.checked = shown;
    box.addEventListener('change', () => {
      set(box.checked);
      redraw();
    });
    text.textContent = name.length > 60 ? `${name.slice(0, 59)}…` : name;
    label.append(box, ' ', text);
    form.append(label);
  }
  after.after(form);
}

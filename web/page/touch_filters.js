// Filters over the table of touches: by part, tool, kind, status and text.

function choice(title, names) {
  const label = document.createElement('label');
  const select = document.createElement('select');
  for (const [value, name] of [['', 'all'], ...names]) {
    const option = document.createElement('option');
    option.value = value;
    option.textContent = name;
    select.append(option);
  }
  label.append(`${title} `, select);
  select.name = title.toLowerCase();
  return { label, select };
}

function search() {
  const label = document.createElement('label');
  const input = document.createElement('input');
  input.type = 'search';
  input.name = 'text';
  label.append('Text ', input);
  return { label, select: input };
}

// `names`: of parts, tools and statuses, in the order of the numbers that rows carry.
export function makeFilters(section, names) {
  if (!section) return;
  const numbered = (list) => list.map((name, i) => [String(i), name]);
  const part = choice('Part', numbered(names.parts));
  const tool = choice('Tool', [['none', 'without a tool'], ...numbered(names.tools)]);
  const kind = choice('Kind', [['touch', 'touches'], ['near', 'near misses']]);
  const status = choice('Status', numbered(names.statuses));
  const text = search();
  const told = document.createElement('output');
  const bar = document.createElement('form');
  bar.className = 'filters';
  bar.append(part.label, tool.label, kind.label, ...(names.statuses.length > 0 ? [status.label] : []), text.label, told);
  bar.addEventListener('submit', (event) => event.preventDefault());

  const rows = [...section.querySelectorAll('tr[data-touch]')];
  function fits(row) {
    const tools = row.dataset.tools.split(' ').filter((word) => word !== '');
    return (part.select.value === '' || row.dataset.part === part.select.value) &&
      (tool.select.value === '' || (tool.select.value === 'none' ? tools.length === 0 : tools.includes(tool.select.value))) &&
      (kind.select.value === '' || row.dataset.kind === kind.select.value) &&
      (status.select.value === '' || row.dataset.status === status.select.value) &&
      row.textContent.toLowerCase().includes(text.select.value.toLowerCase());
  }
  function apply() {
    let shown = 0;
    for (const row of rows) {
      row.hidden = !fits(row);
      shown += row.hidden ? 0 : 1;
    }
    for (const group of section.querySelectorAll('tbody')) group.hidden = !group.querySelector('tr[data-touch]:not([hidden])');
    told.textContent = shown === rows.length ? '' : `${shown} of ${rows.length} rows`;
  }
  bar.addEventListener('input', apply);
  section.querySelector('.scroll').before(bar);
}

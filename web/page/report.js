// What report.html runs. Without it the page shows the same text, tables and pictures, but nothing moves.
import { mountCharts } from './charts_in_page.js';
import { makeModelView } from './model_view.js';
import { makeFilters } from './touch_filters.js';

function main() {
  const data = JSON.parse(document.getElementById('report-data').textContent);
  const rows = [...document.querySelectorAll('tr[data-touch]')];
  const place = document.getElementById('model');
  let view = null;

  function select(touch, { scrolls = false } = {}) {
    for (const row of rows) {
      const isIt = row.dataset.touch === String(touch);
      row.classList.toggle('selected', isIt);
      row.setAttribute('aria-selected', String(isIt));
      if (isIt && scrolls) row.scrollIntoView({ block: 'nearest' });
    }
    if (view) view.show(touch);
  }

  for (const row of rows) {
    row.tabIndex = 0;
    row.addEventListener('click', () => select(Number(row.dataset.touch)));
    row.addEventListener('keydown', (event) => {
      if (event.key !== 'Enter' && event.key !== ' ') return;
      event.preventDefault();
      select(Number(row.dataset.touch));
    });
  }
  document.documentElement.classList.add('runs');
  mountCharts(data.charts, (touch) => select(touch, { scrolls: true }));
  makeFilters(document.getElementById('touches'), data.names);
  if (place) view = makeModelView(place, data.model, data.touches, (touch) => select(touch, { scrolls: true }));
  if (view && data.touches.length > 0) view.show(data.first_touch);
  document.documentElement.dataset.ready = view ? 'with-model' : 'without-model';
}

main();

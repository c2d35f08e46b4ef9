// Models of tools/models that the page offers: file and title.
export const examples = [
  ['bearing_block.step', 'Bearing block (STEP)'], ['teapot.bpt', 'Teapot (bpt)'], ['goblet.json', 'Goblet (JSON)'],
  ['seashell.json', 'Seashell (JSON)'], ['trimmed_crossing_cylinders.json', 'Crossing cylinders (JSON)'],
  ['enneper.json', 'Enneper surface (JSON)'],
];

// Areas, volumes and boxes, each with a bound of its error.
import { optionsOf, setNumbers, truthOf } from './arguments.js';
import { describe } from './handle.js';
import { its } from './internal.js';

const all = 0xffffffffffffffffn;  // -1 of an int64_t
const bodyNames = ['instance', 'shape', 'solid', 'volume', 'volume_error', 'centroid', 'centroid_error', 'inertia',
  'inertia_error', 'gap', 'is_proven'];
const areaNames = ['area', 'area_error', 'centroid', 'centroid_error', 'is_proven'];

function provenOf({ isProven, ...numbers }) { return { ...numbers, isProven: isProven === 1 }; }

/** Measures a model: its area, its box, and its bodies unless `bodies` is false. */
export function measure(model, options) {
  const given = optionsOf('measure', options, ['accuracy', 'bodies', 'progress', 'signal']);
  const module = model[its.module], { TSR_MEASURE_AREAS, TSR_MEASURE_BODIES, TSR_MEASURE_BOX } = module.constants;
  const measures = module.scratch(({ struct, run }) => {
    const wanted = struct('tsr_measure_options', 'tsr_measure_defaults');
    setNumbers(module, wanted, given, { accuracy: 'accuracy' });
    const bodies = truthOf(given, 'bodies', true) ? TSR_MEASURE_BODIES : 0;
    module.set(wanted, 'flags', TSR_MEASURE_AREAS | TSR_MEASURE_BOX | bodies);
    return module.make('tsr_measures_new', model[its.handle], wanted.at, run(given));
  });
  try {
    const { bodies } = describe(module, 'tsr_measures_describe', 'tsr_measures_info', ['bodies'], measures);
    const body = (k) => provenOf(describe(module, 'tsr_measures_body', 'tsr_body', bodyNames, measures, BigInt(k)));
    return {
      ...provenOf(describe(module, 'tsr_measures_area', 'tsr_area', areaNames, measures, all)),
      box: provenOf(describe(module, 'tsr_measures_box', 'tsr_box',
        ['low', 'high', 'low_error', 'high_error', 'is_proven'], measures)),
      bodies: Array.from({ length: bodies }, (_, k) => body(k)),
    };
  } finally {
    module.release(measures);
  }
}

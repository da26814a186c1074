// What the panel says of soft bodies: a row each with its largest strain, and what the colours mean.

const kMostRows = 40;

export const strainText = (strain) => `${strain < 0 ? '−' : '+'}${(100 * Math.abs(strain)).toPrecision(3)} %`;

function volumeText(surface) {
  const volume = surface.volume(), text = `${Number(volume.toPrecision(4))} m³`;
  return surface.restVolume > 0 ? `${text}, ${((100 * volume) / surface.restVolume).toFixed(1)} % of rest` : text;
}

/// Rows of the selection: what they are called, and their texts.
export const kSoftRows = ['position', 'speed', 'particles', 'elements', 'volume', 'largest strain'];
export function softTexts(surface, position, speed) {
  const {soft, largest} = surface, kind = soft.cloth ? 'triangles' : 'tetrahedra';
  return [position, speed, String(soft.count), `${soft.elements} ${kind}`, soft.cloth ? '–' : volumeText(surface),
          strainText(largest)];
}

export class SoftTable {
  constructor(make, recording) {
    this.rows = recording.softs.slice(0, kMostRows).map(({name}, i) => {
      const value = make('td');
      return {i, value, element: make('tr', {}, make('th', {scope: 'row', text: name}), value)};
    });
    this.ends = [make('span'), make('span', {text: '0'}), make('span')];
    this.legend = make('div', {class: 'legend', hidden: ''}, make('i'), make('p', {}, ...this.ends));
    const more = recording.softs.length - this.rows.length;
    this.element = make('div', {class: 'couplings'}, this.legend,
                        make('table', {}, make('tbody', {}, ...this.rows.map(({element}) => element))),
                        more > 0 && make('p', {class: 'hint', text: `and ${more} more`}));
    this.count = recording.softs.length;
  }

  /// `scale` is the strain that is red, minus it that is blue; 0: colours do not show strain.
  show(surfaces, scale) {
    for (const {i, value} of this.rows) {
      const text = strainText(surfaces[i].largest);
      if (value.textContent !== text) value.textContent = text;
    }
    this.legend.hidden = scale === 0;
    this.ends[0].textContent = strainText(-scale);
    this.ends[2].textContent = strainText(scale);
  }
}

// Keys, and the mouse's clicks and hovering; orbiting is three's own.

const kMarks = ['frames', 'limits', 'reactions', 'strain', 'wire', 'balls'];

export function addKeys(viewer) {
  const {actions} = viewer;
  const toggles = {c: 'contacts', v: 'forces', j: 'joints', x: 'frames', m: 'limits', b: 'reactions', n: 'names', t: 'theme', p: 'panel', l: 'loop', g: 'follow', e: 'tail',
                   s: 'strain', w: 'wire', o: 'balls'};
  const keys = {
    ' ': () => actions.togglePlay(),
    ArrowLeft: (event) => actions.step(event.shiftKey ? -10 : -1),
    ArrowRight: (event) => actions.step(event.shiftKey ? 10 : 1),
    Home: () => actions.seek(-Infinity),
    End: () => actions.seek(Infinity),
    '[': () => actions.setSpeed(viewer.interface.nextSpeed(-1)),
    ']': () => actions.setSpeed(viewer.interface.nextSpeed(1)),
    f: () => actions.lookAtSelected(),
    r: () => actions.resetView(),
    '?': () => viewer.interface.toggleKeys(),
    Escape: () => {
      viewer.interface.toggleKeys(false);
      viewer.select(-1);
    },
  };
  window.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === 'SELECT') return;
    // A focused button takes the space key itself.
    if (event.key === ' ' && event.target.tagName === 'BUTTON') return;
    const name = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const button = viewer.interface.toggles[toggles[name]];
    if (kMarks.includes(toggles[name]) && !button) return;  // nothing of the kind to show
    if (toggles[name] && !button?.disabled && !event.repeat) actions.toggle(toggles[name]);
    else if (keys[name]) keys[name](event);
    else return;
    event.preventDefault();
  });
}

export function addPointer(viewer) {
  const {view} = viewer.interface;
  let down, at;
  const place = (event) => {
    const {left, top} = view.getBoundingClientRect();
    return {x: event.clientX - left, y: event.clientY - top};
  };
  view.addEventListener('pointerdown', (event) => {
    down = place(event);
    at = undefined;
  });
  view.addEventListener('pointerup', (event) => {
    const up = place(event);
    if (down && event.button === 0 && Math.hypot(up.x - down.x, up.y - down.y) < 4) viewer.select(viewer.pick(up.x, up.y));
    down = undefined;
  });
  view.addEventListener('pointermove', (event) => { at = event.buttons === 0 ? place(event) : undefined; });
  view.addEventListener('pointerleave', () => {
    at = undefined;
    viewer.hover(-1);
  });
  // Once a picture at most, however many moves the mouse reports.
  let last;
  viewer.hoverNow = () => {
    if (!at || (at === last && !viewer.player.playing)) return;
    last = at;
    viewer.hover(viewer.pick(at.x, at.y));
  };
}

//! What the window decides, without the window: events and times go in, orders come out, and a frame can be painted at any time.
//!
//! Times are seconds since some beginning. While the camera moves there is one draft at a time; each begins when the one
//! before it has come, from where the camera is by then. Once it rests, the full picture is asked for.

mod lines;
mod message;
mod outcome;
mod rate;
#[cfg(test)]
mod tests;

use host_tools::compare::Comparison;
use host_tools::model::{Format, Model};
use host_tools::picture::{Picture, size_is_allowed};

use crate::canvas::{Canvas, draft_size};
use crate::chip::{Effort, TARGETS};
use crate::frame::Frame;
use crate::kernels::{KERNELS, refusal};
use crate::keys::{Hold, Keys};
use crate::overlay;
use crate::painter::{Took, View, Wish};
use crate::walk::{Steer, Walk};
use rate::Rate;

pub use message::{Action, Order, Setup, Update};

/// Seconds without a motion of the mouse after which the camera rests.
const SETTLED: f64 = 0.1;

/// The longest step of motion, seconds: what was slow shall not become a leap.
const LONGEST_STEP: f64 = 0.1;

/// Seconds after which a camera that cannot move any more is looked at again.
const PATIENCE: f64 = 0.02;

/// Radians a pixel of dragging.
const DRAG: f64 = 0.005;

/// What is written over the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shown {
    Status,
    Help,
    Nothing,
}

/// What is known of the picture that is seen.
#[derive(Clone, Debug, Default)]
struct Facts {
    took: Option<Took>,
    /// Seconds from the last motion to the full picture.
    full_after: Option<f64>,
    comparison: Option<Box<Comparison>>,
    effort: Option<Result<Effort, String>>,
    failure: Option<String>,
    /// Samples a pixel of a picture that is to have more.
    samples: Option<u16>,
}

/// The state of everything.
#[derive(Debug)]
pub struct Viewer {
    setup: Setup,
    /// The scene's own way of pixels.
    format: Format,
    /// By the kernels' places: why one has nothing to do with the scene.
    refusals: [Option<String>; KERNELS.len()],
    walk: Walk,
    keys: Keys,
    pad: Steer,
    canvas: Canvas,
    /// The last wish, with its number.
    wish: Option<Wish>,
    /// Whether a draft is being drawn.
    is_drafting: bool,
    stepped_at: f64,
    /// When the mouse moved last.
    dragged_at: f64,
    /// When the camera, or what is seen through it, changed last.
    changed_at: f64,
    rate: Rate,
    /// Drafts that have come.
    drafts: u64,
    facts: Facts,
    /// What the last count says of a board and a kernel: instructions and seconds a ray.
    known: Option<([usize; 2], f64)>,
    shown: Shown,
    message: Option<String>,
    saves_when_full: bool,
}

impl Viewer {
    /// With the camera of a model.
    #[must_use]
    pub fn new(model: &Model, setup: Setup) -> Self {
        Self {
            format: model.render.format,
            refusals: std::array::from_fn(|kernel| refusal(kernel, model)),
            walk: Walk::new(model),
            keys: Keys::default(),
            pad: Steer::default(),
            canvas: Canvas::new([0, 0]),
            wish: None,
            is_drafting: false,
            stepped_at: 0.0,
            dragged_at: f64::NEG_INFINITY,
            changed_at: 0.0,
            rate: Rate::default(),
            drafts: 0,
            facts: Facts::default(),
            known: None,
            shown: Shown::Status,
            message: None,
            saves_when_full: false,
            setup,
        }
    }

    /// What is to be seen now; `None` in a window without pixels.
    #[must_use]
    pub fn view(&self) -> Option<View> {
        let Setup { kernels, size, panel, is_chip, .. } = self.setup;
        let (size, format) = if is_chip { (panel, Format::Rgb565) } else { (size, self.format) };
        let view = View { camera: self.walk.camera(), size, kernel: kernels[usize::from(is_chip)], format };
        size_is_allowed(size[0], size[1]).then_some(view)
    }

    /// The full picture, once it is there.
    #[must_use]
    pub fn full(&self) -> Option<&Picture> {
        self.canvas.full()
    }

    /// Seconds from the last motion to the full picture, once it is there.
    #[must_use]
    pub fn full_after(&self) -> Option<f64> {
        self.facts.full_after
    }

    /// How many drafts have been seen.
    #[must_use]
    pub fn drafts(&self) -> u64 {
        self.drafts
    }

    /// The name of the kernel that draws.
    #[must_use]
    pub fn kernel(&self) -> &'static str {
        KERNELS[self.setup.kernels[usize::from(self.setup.is_chip)]].name()
    }

    /// A key went down or up.
    pub fn hold(&mut self, key: Hold, is_down: bool, now: f64) {
        self.advance(now);
        self.keys.set(key, is_down);
    }

    /// No key is heard of any more.
    pub fn let_go(&mut self, now: f64) {
        self.advance(now);
        self.keys.clear();
    }

    /// The mouse was dragged by so many pixels, to the right and down.
    pub fn drag(&mut self, [right, down]: [f64; 2], now: f64) {
        self.advance(now);
        self.walk.turn(right * DRAG, -down * DRAG);
        (self.dragged_at, self.changed_at) = (now, now);
    }

    /// The wheel was turned by so many notches.
    pub fn zoom(&mut self, notches: f64, now: f64) {
        self.walk.zoom(notches);
        (self.dragged_at, self.changed_at) = (now, now);
    }

    /// The window has another size, be it nothing.
    pub fn resize(&mut self, size: [u32; 2], now: f64) {
        if size != self.setup.size {
            self.setup.size = size;
            self.changed_at = now;
        }
    }

    /// A key that does something once.
    pub fn act(&mut self, action: Action, now: f64) -> Vec<Order> {
        self.advance(now);
        self.message = None;
        match action {
            Action::Kernel(kernel) => {
                if let Some(Some(reason)) = self.refusals.get(kernel) {
                    return vec![Order::Warn(reason.clone())];
                }
                if kernel < KERNELS.len() {
                    self.setup.kernels[usize::from(self.setup.is_chip)] = kernel;
                }
            }
            Action::Chip => self.setup.is_chip = !self.setup.is_chip,
            Action::Board => {
                self.setup.board = (self.setup.board + 1) % TARGETS.len();
                self.facts.effort = None;
                return self.time();
            }
            Action::Save => match self.canvas.full() {
                Some(picture) => return vec![Order::Save(picture.clone(), self.kernel())],
                None => self.saves_when_full = true,
            },
            Action::WriteCamera => return vec![Order::WriteCamera(self.walk.camera())],
            Action::Home => self.walk.go_home(),
            Action::Overlay => {
                self.shown = match self.shown {
                    Shown::Status => Shown::Help,
                    Shown::Help => Shown::Nothing,
                    Shown::Nothing => Shown::Status,
                };
                return Vec::new();
            }
            Action::Quit => return vec![Order::Quit],
        }
        self.changed_at = now;
        Vec::new()
    }

    /// Something has become of an order.
    pub fn update(&mut self, update: Update, now: f64) -> Vec<Order> {
        let newest = self.serial();
        match update {
            Update::Drawn(serial, drawn) if serial == newest => return self.drawn(drawn, now),
            Update::Judged(serial, comparison) if serial == newest => self.facts.comparison = Some(comparison),
            Update::Timed(serial, effort) if serial == newest => self.timed(effort),
            Update::Drawn(..) | Update::Judged(..) | Update::Timed(..) => {}
            Update::Pad(pad) => {
                self.advance(now);
                self.pad = pad.steer();
            }
            Update::Said(message) => self.message = Some(message),
        }
        Vec::new()
    }

    /// What is to be drawn by now.
    pub fn tick(&mut self, now: f64) -> Option<Order> {
        self.advance(now);
        let view = self.view()?;
        let is_moving = self.is_moving(now);
        if is_moving && self.is_drafting {
            return None;
        }
        // A panel's picture is small enough.
        let draft = is_moving.then(|| if self.setup.is_chip { view.size } else { draft_size(view.size) });
        let is_wished = self.wish.is_some_and(|wish| wish.view == view && (wish.draft == draft || is_moving));
        if is_wished {
            return None;
        }
        let wish = Wish { serial: self.serial() + 1, view, draft };
        match draft {
            Some(_) => self.canvas.outdate(),
            None => self.canvas.begin(view.size),
        }
        self.wish = Some(wish);
        self.is_drafting = is_moving;
        self.facts = Facts { took: self.facts.took, ..Facts::default() };
        Some(Order::Draw(wish))
    }

    /// When it has to be asked again, should nothing happen before.
    #[must_use]
    pub fn deadline(&self, now: f64) -> Option<f64> {
        if !self.steer().is_still() {
            return (!self.is_drafting).then_some(now + PATIENCE);
        }
        let settled = self.dragged_at + SETTLED;
        (now < settled).then_some(settled)
    }

    /// Paints the window.
    pub fn paint(&self, frame: &mut Frame<'_>) {
        let [width, height] = self.canvas.size();
        let scale = if self.setup.is_chip {
            let [across, down] = self.setup.size;
            (across / width.max(1)).min(down / height.max(1)).max(1)
        } else {
            1
        };
        frame.show(self.canvas.picture(), scale);
        overlay::write(frame, &self.lines());
    }

    fn serial(&self) -> u64 {
        self.wish.map_or(0, |wish| wish.serial)
    }

    fn steer(&self) -> Steer {
        self.keys.steer().plus(self.pad)
    }

    fn is_moving(&self, now: f64) -> bool {
        !self.steer().is_still() || now < self.dragged_at + SETTLED
    }

    /// Goes on as it was asked for since the last time.
    fn advance(&mut self, now: f64) {
        let seconds = (now - self.stepped_at).clamp(0.0, LONGEST_STEP);
        self.stepped_at = now;
        let steer = self.steer();
        if !steer.is_still() {
            self.walk.step(&steer, seconds);
            self.changed_at = now;
        }
    }
}

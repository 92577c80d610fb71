//! The window: events to the viewer, its orders to the staff, its frames to the screen.

mod bindings;

use std::fmt::Display;
use std::num::NonZeroU32;
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};

use host_tools::cli::{note, output, warn};
use softbuffer::{Context, SoftBufferError, Surface};
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, MouseButton, MouseScrollDelta, StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, OwnedDisplayHandle};
use winit::keyboard::PhysicalKey;
use winit::window::{Window, WindowId};

use crate::frame::Frame;
use crate::measure::Pilot;
use crate::pad;
use crate::painter::{Drawn, Scene};
use crate::staff::{Staff, Tell, Then};
use crate::viewer::{Order, Setup, Update, Viewer};
use bindings::{Key, key};

/// Pixels of a touchpad's scrolling that make a notch of a wheel.
const NOTCH: f64 = 40.0;

/// Why there is no window, for a person.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WindowError {
    /// None can be had here.
    NoDisplay(String),
    /// Something else.
    Failed(String),
}

/// Opens the window and stays until it is closed. A `pilot` moves instead of the user and closes it; it comes back where all
/// of its flight was flown.
///
/// # Errors
/// Where there is no display, or nothing can be shown on it.
pub fn run(
    path: &Path,
    scene: &Scene,
    setup: Setup,
    threads: usize,
    pilot: Option<Pilot>,
) -> Result<Option<Pilot>, WindowError> {
    let absent = |error: &dyn Display| WindowError::NoDisplay(error.to_string());
    let failed = |error: &dyn Display| WindowError::Failed(error.to_string());
    let events = EventLoop::<Update>::with_user_event().build().map_err(|error| absent(&error))?;
    let context = Context::new(events.owned_display_handle()).map_err(|error| absent(&error))?;
    let proxy = events.create_proxy();
    let tell: Tell = Arc::new(move |update| {
        // Where the window is closed, nobody listens.
        let _ = proxy.send_event(update);
    });
    let staff = Staff::new(path.into(), scene, threads, &tell).map_err(WindowError::Failed)?;
    if pilot.is_none() {
        match pad::listen(move |pad| tell(Update::Pad(pad))) {
            Some(name) => note(format_args!("gamepad: {name}")),
            None => note("there is no gamepad; mouse and keys will do (H shows them)"),
        }
    }
    let is_flown = pilot.is_some();
    let mut app = App {
        title: format!("intray view: {}", path.display()),
        size: setup.size,
        viewer: Viewer::new(&scene.model, setup),
        staff,
        context,
        begin: Instant::now(),
        screen: None,
        cursor: [0.0; 2],
        is_dragging: false,
        pilot,
        is_landed: false,
        failure: None,
    };
    events.run_app(&mut app).map_err(|error| failed(&error))?;
    match app.failure {
        Some(reason) => Err(WindowError::Failed(reason)),
        None if is_flown && !app.is_landed => Err(WindowError::Failed("the window was closed too soon".into())),
        None => Ok(app.pilot),
    }
}

/// A window and its pixels.
struct Screen {
    window: Rc<Window>,
    surface: Surface<OwnedDisplayHandle, Rc<Window>>,
}

struct App {
    title: String,
    /// The size to begin with.
    size: [u32; 2],
    viewer: Viewer,
    staff: Staff,
    context: Context<OwnedDisplayHandle>,
    begin: Instant,
    screen: Option<Screen>,
    cursor: [f64; 2],
    is_dragging: bool,
    pilot: Option<Pilot>,
    /// Whether the pilot has flown all of its flight.
    is_landed: bool,
    failure: Option<String>,
}

impl App {
    /// Seconds since the beginning.
    fn now(&self) -> f64 {
        self.begin.elapsed().as_secs_f64()
    }

    /// Makes the window.
    fn open(&self, events: &ActiveEventLoop) -> Result<Screen, String> {
        let attributes = Window::default_attributes()
            .with_title(self.title.clone())
            .with_inner_size(PhysicalSize::new(self.size[0], self.size[1]));
        let window = Rc::new(events.create_window(attributes).map_err(|error| error.to_string())?);
        let surface = Surface::new(&self.context, window.clone()).map_err(|error| error.to_string())?;
        Ok(Screen { window, surface })
    }

    /// Carries out orders; what they say is said in the window and on standard output or error.
    fn carry_out(&mut self, events: &ActiveEventLoop, orders: impl IntoIterator<Item = Order>) {
        for order in orders {
            let mut said = Vec::new();
            if self.staff.carry_out(order, &mut |message| said.push(message)) == Then::End {
                events.exit();
            }
            for message in said {
                match &message {
                    // Where nobody reads it, it still stands in the window.
                    Ok(done) => drop(output::line(done)),
                    Err(reason) => warn(reason),
                }
                let now = self.now();
                self.viewer.update(Update::Said(message.unwrap_or_else(|reason| reason)), now);
            }
        }
    }

    /// After whatever happened: what is to be drawn now, and when to look again.
    fn go_on(&mut self, events: &ActiveEventLoop) {
        let now = self.now();
        if let Some(pilot) = &mut self.pilot
            && pilot.fly(&mut self.viewer, now)
        {
            self.is_landed = true;
            events.exit();
        }
        let order = self.viewer.tick(now);
        self.carry_out(events, order);
        let wake = self.viewer.deadline(now).map(|deadline| self.begin + Duration::from_secs_f64(deadline));
        events.set_control_flow(wake.map_or(ControlFlow::Wait, ControlFlow::WaitUntil));
        if let Some(screen) = &self.screen {
            screen.window.request_redraw();
        }
    }

    /// Paints the window; one without pixels is left alone.
    fn paint(&mut self) -> Result<(), SoftBufferError> {
        let Some(Screen { window, surface }) = &mut self.screen else { return Ok(()) };
        let PhysicalSize { width, height } = window.inner_size();
        let Some((across, down)) = NonZeroU32::new(width).zip(NonZeroU32::new(height)) else { return Ok(()) };
        surface.resize(across, down)?;
        let mut pixels = surface.buffer_mut()?;
        if let Some(mut frame) = Frame::new(&mut pixels, [width, height]) {
            self.viewer.paint(&mut frame);
        }
        window.pre_present_notify();
        pixels.present()
    }

    fn key(&mut self, events: &ActiveEventLoop, key: Key, is_down: bool, repeats: bool) {
        let now = self.now();
        match key {
            Key::Hold(hold) => self.viewer.hold(hold, is_down, now),
            Key::Zoom(notches) if is_down => self.viewer.zoom(notches.into(), now),
            Key::Act(action) if is_down && !repeats => {
                let orders = self.viewer.act(action, now);
                self.carry_out(events, orders);
            }
            Key::Zoom(_) | Key::Act(_) => {}
        }
    }

    fn pointed(&mut self, place: [f64; 2]) {
        let way = [0, 1].map(|axis| place[axis] - self.cursor[axis]);
        self.cursor = place;
        if self.is_dragging {
            let now = self.now();
            self.viewer.drag(way, now);
        }
    }
}

impl ApplicationHandler<Update> for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        match self.open(events) {
            Ok(screen) => self.screen = Some(screen),
            Err(reason) => {
                self.failure = Some(format!("no window can be opened: {reason}"));
                events.exit();
            }
        }
        self.go_on(events);
    }

    fn suspended(&mut self, _: &ActiveEventLoop) {
        self.screen = None;
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        // At once, whatever has still to be waited for.
        self.screen = None;
    }

    fn new_events(&mut self, events: &ActiveEventLoop, cause: StartCause) {
        if matches!(cause, StartCause::ResumeTimeReached { .. }) {
            self.go_on(events);
        }
    }

    fn user_event(&mut self, events: &ActiveEventLoop, update: Update) {
        if let (Update::Drawn(_, Drawn::Failed(reason)), Some(_)) = (&update, &self.pilot) {
            self.failure = Some(reason.clone());
            events.exit();
        }
        let now = self.now();
        let orders = self.viewer.update(update, now);
        self.carry_out(events, orders);
        self.go_on(events);
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let now = self.now();
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::RedrawRequested => {
                if let Err(error) = self.paint() {
                    self.failure = Some(format!("the window cannot be painted: {error}"));
                    events.exit();
                }
                return;
            }
            WindowEvent::Resized(PhysicalSize { width, height }) => self.viewer.resize([width, height], now),
            WindowEvent::Focused(false) => {
                self.is_dragging = false;
                self.viewer.let_go(now);
            }
            WindowEvent::KeyboardInput { event, is_synthetic: false, .. } => {
                if let PhysicalKey::Code(code) = event.physical_key
                    && let Some(key) = key(code)
                {
                    self.key(events, key, event.state == ElementState::Pressed, event.repeat);
                }
            }
            WindowEvent::MouseInput { state, button: MouseButton::Left, .. } => {
                self.is_dragging = state == ElementState::Pressed;
            }
            WindowEvent::CursorMoved { position, .. } => {
                self.pointed([position.x, position.y]);
                if !self.is_dragging {
                    return;
                }
            }
            WindowEvent::MouseWheel { delta, .. } => {
                let notches = match delta {
                    MouseScrollDelta::LineDelta(_, lines) => lines.into(),
                    MouseScrollDelta::PixelDelta(pixels) => pixels.y / NOTCH,
                };
                self.viewer.zoom(notches, now);
            }
            _ => return,
        }
        self.go_on(events);
    }
}

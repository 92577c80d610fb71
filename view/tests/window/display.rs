//! A display of memory alone (Xvfb), and the command in a window on it.

use std::io::{BufRead, BufReader, ErrorKind, Read};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

use host_tools::picture::Picture;
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{
    self, ConfigureWindowAux, ConnectionExt as _, ImageFormat, InputFocus, MapState, Window,
};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;

/// How long anything may take: no measure of speed, but an end to waiting for what never comes.
const PATIENCE: Duration = Duration::from_secs(120);

/// Between two looks.
const PAUSE: Duration = Duration::from_millis(20);

/// A key by its place on the keyboard: evdev's number and 8.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Key(u8);

impl Key {
    pub(crate) const ESCAPE: Self = Self(9);
    pub(crate) const W: Self = Self(25);
    pub(crate) const E: Self = Self(26);
    pub(crate) const R: Self = Self(27);
    pub(crate) const O: Self = Self(32);
    pub(crate) const P: Self = Self(33);
    pub(crate) const S: Self = Self(39);
    pub(crate) const D: Self = Self(40);
    pub(crate) const H: Self = Self(43);
    pub(crate) const LEFT: Self = Self(113);

    /// The number key of a place, from 0.
    pub(crate) fn digit(place: usize) -> Self {
        Self(10 + place as u8)
    }
}

/// An X server without hardware.
#[derive(Debug)]
pub(crate) struct Display {
    server: Child,
    name: String,
}

impl Display {
    /// Starts one under a number that is free; `None`, with a line that says so, where Xvfb is absent.
    pub(crate) fn start() -> Option<Self> {
        let started = Command::new("Xvfb")
            .args("-displayfd 1 -noreset -screen 0 800x600x24 -nolisten tcp".split(' '))
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn();
        let mut server = match started {
            Ok(server) => server,
            Err(error) if error.kind() == ErrorKind::NotFound => {
                println!("skipped: Xvfb is not installed (apt-get install xvfb)");
                return None;
            }
            Err(error) => panic!("Xvfb cannot be started: {error}"),
        };
        let mut number = String::new();
        BufReader::new(server.stdout.as_mut().unwrap()).read_line(&mut number).unwrap();
        Some(Self { server, name: format!(":{}", number.trim()) })
    }

    /// Opens a scene's window, with the keyboard.
    pub(crate) fn open(&self, folder: &Path, line: &str) -> Session<'_> {
        let mut child = Command::new(env!("CARGO_BIN_EXE_intray-view"))
            .args(line.split(' '))
            .current_dir(folder)
            .env("DISPLAY", &self.name)
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("WAYLAND_SOCKET")
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let output = lines(child.stdout.take().unwrap());
        let errors = lines(child.stderr.take().unwrap());
        let (connection, screen) = x11rb::connect(Some(&self.name)).unwrap();
        let root = connection.setup().roots[screen].root;
        let mut session = Session { child, output, errors, connection, root, window: root, _display: self };
        session.window = session.wait("the window", Session::find);
        session.focus();
        session
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

/// The lines that come, on a thread of their own.
fn lines(stream: impl Read + Send + 'static) -> Receiver<String> {
    let (sender, receiver) = channel();
    thread::spawn(move || {
        for line in BufReader::new(stream).lines().map_while(Result::ok) {
            if sender.send(line).is_err() {
                break;
            }
        }
    });
    receiver
}

/// The command in its window.
#[derive(Debug)]
pub(crate) struct Session<'a> {
    child: Child,
    output: Receiver<String>,
    errors: Receiver<String>,
    connection: RustConnection,
    root: Window,
    window: Window,
    _display: &'a Display,
}

impl Session<'_> {
    /// The next line on standard output.
    pub(crate) fn line(&self) -> String {
        self.output.recv_timeout(PATIENCE).unwrap()
    }

    /// The next warning on standard error.
    pub(crate) fn warning(&self) -> String {
        loop {
            let line = self.errors.recv_timeout(PATIENCE).unwrap();
            if line.starts_with("warning: ") {
                return line;
            }
        }
    }

    /// Presses keys together, and lets them go after a time in milliseconds.
    pub(crate) fn hold(&self, keys: &[Key], milliseconds: u64) {
        keys.iter().for_each(|&Key(code)| self.fake(xproto::KEY_PRESS_EVENT, code, [0, 0]));
        thread::sleep(Duration::from_millis(milliseconds));
        keys.iter().for_each(|&Key(code)| self.fake(xproto::KEY_RELEASE_EVENT, code, [0, 0]));
    }

    /// Presses a key, and lets it go.
    pub(crate) fn press(&self, key: Key) {
        self.hold(&[key], 0);
    }

    /// Drags the mouse from a place in the window to another.
    pub(crate) fn drag(&self, from: [i16; 2], to: [i16; 2]) {
        self.fake(xproto::MOTION_NOTIFY_EVENT, 0, from);
        self.fake(xproto::BUTTON_PRESS_EVENT, 1, [0, 0]);
        for step in 1..=4 {
            thread::sleep(PAUSE);
            self.fake(
                xproto::MOTION_NOTIFY_EVENT,
                0,
                [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) / 4 * step),
            );
        }
        self.fake(xproto::BUTTON_RELEASE_EVENT, 1, [0, 0]);
    }

    /// Turns the wheel away from the user, or towards them.
    pub(crate) fn wheel(&self, away: bool, notches: u32) {
        for _ in 0..notches {
            for event in [xproto::BUTTON_PRESS_EVENT, xproto::BUTTON_RELEASE_EVENT] {
                self.fake(event, if away { 4 } else { 5 }, [0, 0]);
            }
        }
    }

    /// Gives the window another size, as a window manager would.
    pub(crate) fn resize(&self, [width, height]: [u32; 2]) {
        let size = ConfigureWindowAux::new().width(width).height(height);
        self.connection.configure_window(self.window, &size).unwrap().check().unwrap();
        self.wait("the new size", |session| (session.size() == [width, height]).then_some(()));
        self.focus();
    }

    /// What is seen in the window.
    pub(crate) fn screenshot(&self) -> Picture {
        let [width, height] = self.size();
        let [across, down] = [width, height].map(|side| side as u16);
        let image = self.connection.get_image(ImageFormat::Z_PIXMAP, self.window, 0, 0, across, down, !0).unwrap();
        let pixels = image.reply().unwrap().data;
        let pixels: &[[u8; 4]] = pixels.as_chunks().0;
        assert_eq!(pixels.len(), (width * height) as usize, "four bytes a pixel");
        Picture::from_fn(width, height, |x, y| {
            let [blue, green, red, _] = pixels[(y * width + x) as usize];
            [red, green, blue]
        })
    }

    /// Waits until exactly this is seen.
    #[track_caller]
    pub(crate) fn wait_for(&self, picture: &Picture) {
        let begin = Instant::now();
        loop {
            let seen = self.screenshot();
            if seen == *picture {
                return;
            }
            if begin.elapsed() > PATIENCE {
                let pairs = seen.pixels().iter().zip(picture.pixels());
                let other = pairs.filter(|(seen, expected)| seen != expected).count();
                panic!("{other} of {} pixels are not as expected", picture.pixels().len());
            }
            thread::sleep(PAUSE);
        }
    }

    /// Waits for the command to end; its exit status.
    pub(crate) fn end(mut self) -> Option<i32> {
        let begin = Instant::now();
        while begin.elapsed() < PATIENCE {
            if let Some(status) = self.child.try_wait().unwrap() {
                return status.code();
            }
            thread::sleep(PAUSE);
        }
        panic!("it does not end");
    }

    fn fake(&self, event: u8, detail: u8, [x, y]: [i16; 2]) {
        self.connection.xtest_fake_input(event, detail, 0, self.root, x, y, 0).unwrap().check().unwrap();
    }

    fn focus(&self) {
        let focus = self.connection.set_input_focus(InputFocus::PARENT, self.window, x11rb::CURRENT_TIME);
        focus.unwrap().check().unwrap();
        self.fake(xproto::MOTION_NOTIFY_EVENT, 0, [0, 0]);
    }

    fn size(&self) -> [u32; 2] {
        let geometry = self.connection.get_geometry(self.window).unwrap().reply().unwrap();
        [geometry.width.into(), geometry.height.into()]
    }

    /// The window, once it is seen: there is no other of any size.
    fn find(&self) -> Option<Window> {
        let tree = self.connection.query_tree(self.root).ok()?.reply().ok()?;
        tree.children.into_iter().find(|&window| {
            let attributes = self.connection.get_window_attributes(window).ok().and_then(|asked| asked.reply().ok());
            attributes.is_some_and(|attributes| attributes.map_state == MapState::VIEWABLE)
        })
    }

    fn wait<T>(&self, what: &str, of: impl Fn(&Self) -> Option<T>) -> T {
        let begin = Instant::now();
        loop {
            if let Some(found) = of(self) {
                return found;
            }
            assert!(begin.elapsed() < PATIENCE, "{what} does not come");
            thread::sleep(PAUSE);
        }
    }
}

impl Drop for Session<'_> {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

//! Those who carry out orders: a thread each that draws, judges and times.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread::JoinHandle;

use host_tools::model::Camera;
use host_tools::picture::Picture;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::chip;
use crate::desk::Desk;
use crate::judge;
use crate::painter::{self, Scene, Wish};
use crate::scene_file;
use crate::viewer::{Order, Update};

/// Told what becomes of orders, from any thread.
pub type Tell = Arc<dyn Fn(Update) + Send + Sync>;

/// What an order asks of whoever gives it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Then {
    /// To go on.
    GoOn,
    /// To end.
    End,
}

/// The threads, which end where this is dropped.
#[derive(Debug)]
pub struct Staff {
    path: PathBuf,
    home: Camera,
    newest: Arc<AtomicU64>,
    wishes: Arc<Desk<Wish>>,
    cases: Arc<Desk<judge::Case>>,
    jobs: Arc<Desk<chip::Job>>,
    threads: Vec<JoinHandle<()>>,
}

impl Staff {
    /// Begins work on a scene of a file.
    ///
    /// # Errors
    /// Where there are no threads to be had, for a person.
    pub fn new(path: PathBuf, scene: &Scene, threads: usize, tell: &Tell) -> Result<Self, String> {
        let mut staff = Self {
            path,
            home: scene.model.camera,
            newest: Arc::default(),
            wishes: Arc::default(),
            cases: Arc::default(),
            jobs: Arc::default(),
            threads: Vec::new(),
        };
        let painters = pool(threads)?;
        // One thread, so that who begins to move again need not wait for it.
        let judges = pool(1)?;
        let (desk, of, tell_drawn) = (staff.wishes.clone(), scene.clone(), tell.clone());
        staff.hire("painter", move || {
            painter::work(&of, &desk, &painters, &|serial, drawn| tell_drawn(Update::Drawn(serial, drawn)));
        })?;
        let (desk, of, newest, tell_judged) = (staff.cases.clone(), scene.clone(), staff.newest.clone(), tell.clone());
        staff.hire("judge", move || {
            judge::work(&of, &desk, &newest, &judges, &|serial, comparison| {
                tell_judged(Update::Judged(serial, Box::new(comparison)));
            });
        })?;
        let (desk, of, newest, tell_timed) = (staff.jobs.clone(), scene.clone(), staff.newest.clone(), tell.clone());
        staff.hire("timer", move || {
            chip::work(&of, &desk, &newest, &|serial, effort| tell_timed(Update::Timed(serial, effort)));
        })?;
        Ok(staff)
    }

    /// Carries out an order, or sees to it; what came of it, or what is wrong, is told to `say` if it is known at once.
    pub fn carry_out(&self, order: Order, say: &mut dyn FnMut(Result<String, String>)) -> Then {
        match order {
            Order::Draw(wish) => {
                self.newest.store(wish.serial, Ordering::Relaxed);
                self.wishes.lay(wish);
            }
            Order::Judge(case) => self.cases.lay(case),
            Order::Time(job) => self.jobs.lay(job),
            Order::Save(picture, kernel) => say(self.save(&picture, kernel)),
            Order::WriteCamera(camera) => {
                let written = scene_file::write(&self.path, &self.home, &camera);
                say(written.map(|()| format!("{}: the camera is written", self.path.display())));
            }
            Order::Warn(reason) => say(Err(reason)),
            Order::Quit => return Then::End,
        }
        Then::GoOn
    }

    fn hire(&mut self, name: &str, work: impl FnOnce() + Send + 'static) -> Result<(), String> {
        let thread = std::thread::Builder::new().name(name.into()).spawn(work);
        self.threads.push(thread.map_err(|error| format!("no thread can be started: {error}"))?);
        Ok(())
    }

    /// Saves a picture in the current folder, under a name that is free; what is to be said of it.
    fn save(&self, picture: &Picture, kernel: &str) -> Result<String, String> {
        let stem = self.path.file_stem().unwrap_or_default().display().to_string();
        let name = |number: u32| PathBuf::from(format!("{stem}-{kernel}-{number}.png"));
        let free = (1..=u32::MAX).map(name).find(|name| !name.exists());
        let free = free.ok_or_else(|| format!("{stem}-{kernel}: there is no free name for the picture"))?;
        picture.write_png(&free).map_err(|error| error.to_string())?;
        Ok(format!("{}: saved", free.display()))
    }
}

impl Drop for Staff {
    fn drop(&mut self) {
        self.newest.store(u64::MAX, Ordering::Relaxed);
        self.wishes.close();
        self.cases.close();
        self.jobs.close();
        // An emulator that runs is waited for, so that nothing of it is left behind.
        for thread in self.threads.drain(..) {
            // A thread that ended otherwise has said why.
            let _ = thread.join();
        }
    }
}

fn pool(threads: usize) -> Result<ThreadPool, String> {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|error| format!("no threads can be started: {error}"))
}

//! Runs on emulated chips whose instructions are counted.

use std::path::Path;
use std::time::Duration;

use firmware_rt::board::Board;
use firmware_rt::hits::Way;
use host_tools::builtin;
use host_tools::emulate::breakdown::Breakdown;
use host_tools::emulate::counter::{Counter, Counts};
use host_tools::emulate::elf::Elf;
use host_tools::emulate::firmware::Wanted;
use host_tools::emulate::{EmulateError, Outcome, Run};
use host_tools::engine;
use host_tools::import::{self, Embedded};
use host_tools::model::Model;
use host_tools::prepare::{Blob, Options};

const LIMIT: Duration = Duration::from_secs(600);

/// A scene of the repository by its folder, or the built-in one, at a size.
///
/// # Panics
/// If there is none.
#[must_use]
pub fn scene(name: &str, size: [u32; 2]) -> Model {
    let loaded = match name {
        "built-in" => import::load_from(&Embedded(builtin::FILES), "scene.toml"),
        _ => import::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../scenes/{name}/scene.toml"))),
    };
    let mut model = loaded.expect("a scene of the repository").model;
    model.render.size = size;
    model
}

/// What is rendered on a chip.
#[derive(Debug)]
pub struct Job {
    board: &'static Board,
    blob: Blob,
    hits: Option<Way>,
}

impl Job {
    /// A scene by a kernel; the nearest hits alone where `hits` says how.
    ///
    /// # Panics
    /// If the kernel cannot hold it.
    #[must_use]
    pub fn new(board: &'static Board, model: &Model, kernel: &str, hits: Option<Way>) -> Self {
        let engine = engine::by_name(kernel).expect("a kernel of this name");
        Self { board, blob: engine.prepare(model, &Options::default()).expect("it fits").blob, hits }
    }

    /// The bytes of the blob.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.blob.bytes().len()
    }

    fn wanted(&self) -> Wanted<'_> {
        Wanted { board: self.board, blob: self.blob.bytes(), hits: self.hits, count: false }
    }

    /// Runs a firmware for it.
    fn run(&self, elf: Result<Elf, EmulateError>, counter: Option<&Counter>) -> Result<Outcome, EmulateError> {
        Run { board: self.board, elf: &elf?, blob: Some(self.blob.bytes()), counter, limit: LIMIT }
            .perform(&mut Vec::new())
    }

    /// What it takes.
    ///
    /// # Panics
    /// If it cannot be built or run.
    #[must_use]
    pub fn counts(&self, counter: &Counter) -> Counts {
        let outcome = self.run(self.wanted().provide(), Some(counter)).expect("it goes well");
        outcome.counts.expect("they were counted")
    }

    /// What it takes by kind of ray and by part of the program.
    ///
    /// # Panics
    /// If it cannot be built or run.
    #[must_use]
    pub fn breakdown(&self, counter: &Counter, plain: u64) -> Breakdown {
        let work = self.run(Wanted { count: true, ..self.wanted() }.provide(), None).expect("it goes well").report;
        let marked = self.run(self.wanted().provide_marked(), Some(&counter.by_part())).expect("it goes well");
        let rays = [work.primary_rays, work.shadow_rays, work.reflection_rays, work.refraction_rays];
        Breakdown::new(&marked.counts.expect("they were counted"), plain, rays).expect("counts with marks")
    }
}

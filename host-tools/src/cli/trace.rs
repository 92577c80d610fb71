//! `intray trace`: the nearest hits of rays, from CSV to CSV.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Seek, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::builder::PossibleValuesParser;
use glam::DVec3;
use indicatif::ProgressBar;
use rayon::prelude::*;
use serde::Serialize;

use super::failure::Failure;
use super::input::{SceneArguments, ThreadArguments};
use super::{output, progress};
use crate::engine::ENGINES;
use crate::files::{self, AtomicFile, FileError};
use crate::planes::{self, trace::Tracer};
use crate::reference::Reference;
use crate::trace::{HITS_HEADER, Rays, Trace, write_hit};

/// The f64 tracer of the undiscretised scene, beside the kernels.
const REFERENCE: &str = "reference";

/// Rays in memory at a time.
const CHUNK: usize = 1 << 16;
/// Rays that a thread takes at a time.
const RUN: usize = 1 << 10;

/// Trace rays of your own: the golden model
///
/// IN.csv has the line ox,oy,oz,dx,dy,dz and under it a ray a line, in scene units. OUT.csv has the line hit,t,prim,u,v
/// and under it the nearest hits (0,,,, for none), with point = o + t d = (1-u-v) v0 + u v1 + v v2, and prim the
/// triangle's place in the file, from 0.
#[derive(Debug, clap::Args)]
#[command(mut_arg("kernel", |kernel| kernel
    .value_parser(PossibleValuesParser::new(ENGINES.iter().map(|engine| engine.name()).chain([planes::NAME, REFERENCE])))))]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,

    /// Where the rays are; `-` is standard input
    #[arg(long, value_name = "IN.csv")]
    rays: PathBuf,

    /// Where the hits go; `-` is standard output
    #[arg(short, value_name = "OUT.csv")]
    output: PathBuf,

    #[command(flatten)]
    threads: ThreadArguments,

    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// The answer.
#[derive(Debug, Serialize)]
struct Report {
    kernel: &'static str,
    rays: u64,
    hits: u64,
    threads: usize,
    /// Of reading, tracing and writing.
    seconds: f64,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if is_standard(&arguments.output) {
        if arguments.json {
            return Err(Failure::input("--json prints to standard output, where -o - sends the hits; give a file"));
        }
    } else {
        files::check_writable(&arguments.output)?;
    }
    if arguments.scene.kernel.as_deref() == Some(REFERENCE) {
        return trace(arguments, REFERENCE, &Reference::new(&arguments.scene.model_for_reference()?));
    }
    if arguments.scene.is_planes() {
        let planes = super::planes::prepare(&arguments.scene)?.0;
        return trace(arguments, planes::NAME, &Tracer::new(planes.scene()?, planes.place()));
    }
    let scene = arguments.scene.load()?;
    let tracer = scene.engine.tracer(scene.blob.bytes())?;
    trace(arguments, scene.engine.name(), tracer.as_ref())
}

/// Traces all rays by `tracer`.
fn trace(arguments: &Arguments, kernel: &'static str, tracer: &dyn Trace) -> Result<(), Failure> {
    let begin = Instant::now();
    let pool = arguments.threads.pool()?;
    let (mut rays, bar) = open(&arguments.rays)?;
    let mut sink = Sink::create(&arguments.output)?;
    sink.write(format!("{HITS_HEADER}\n").as_bytes())?;
    let mut report = Report { kernel, rays: 0, hits: 0, threads: pool.current_num_threads(), seconds: 0.0 };
    loop {
        let chunk: Vec<[DVec3; 2]> = rays.by_ref().take(CHUNK).collect::<Result<_, _>>()?;
        if chunk.is_empty() {
            break;
        }
        let traced: Vec<(String, u64)> =
            pool.install(|| chunk.par_chunks(RUN).map(|rays| rows(tracer, rays)).collect());
        for (rows, hits) in traced {
            sink.write(rows.as_bytes())?;
            report.hits += hits;
        }
        report.rays += chunk.len() as u64;
    }
    bar.finish_and_clear();
    sink.finish()?;
    if is_standard(&arguments.output) {
        return Ok(());
    }
    report.seconds = begin.elapsed().as_secs_f64();
    if arguments.json {
        return output::json(&report);
    }
    output::line(&format!(
        "{}: {} rays by {kernel}, {} of them hit, in {:.2} s on {} threads",
        arguments.output.display(),
        report.rays,
        report.hits,
        report.seconds,
        report.threads
    ))
}

/// The rows of some rays, and how many of these hit.
fn rows(tracer: &dyn Trace, rays: &[[DVec3; 2]]) -> (String, u64) {
    let (mut text, mut hits) = (String::new(), 0);
    for &[origin, direction] in rays {
        let hit = tracer.nearest(origin, direction);
        hits += u64::from(hit.is_some());
        // A string takes whatever there is.
        let _ = write_hit(&mut text, hit.as_ref());
    }
    (text, hits)
}

/// Where rows wait until all rays are known to be good.
enum Sink {
    File(AtomicFile),
    /// Without a name, for standard output.
    Unnamed(File),
}

impl Sink {
    fn create(path: &Path) -> Result<Self, Failure> {
        if is_standard(path) {
            return tempfile::tempfile().map(Self::Unnamed).map_err(unwritten);
        }
        Ok(Self::File(AtomicFile::create(path)?))
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), Failure> {
        match self {
            Self::File(file) => Ok(file.write(bytes)?),
            Self::Unnamed(file) => file.write_all(bytes).map_err(unwritten),
        }
    }

    fn finish(self) -> Result<(), Failure> {
        let mut file = match self {
            Self::File(file) => return Ok(file.finish()?),
            Self::Unnamed(file) => file,
        };
        match file.rewind().and_then(|()| io::copy(&mut file, &mut io::stdout().lock())) {
            // A reader that stops reading is no error.
            Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(unwritten(error)),
            _ => Ok(()),
        }
    }
}

fn unwritten(error: io::Error) -> Failure {
    Failure::input(format!("cannot write to standard output: {error}"))
}

/// A name that stands for standard input or output.
fn is_standard(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// The rays of a file, and a bar that moves as they are read.
fn open(path: &Path) -> Result<(Rays<Box<dyn BufRead>>, ProgressBar), Failure> {
    if is_standard(path) {
        let bar = progress::spinner("tracing");
        let input: Box<dyn BufRead> = Box::new(io::stdin().lock());
        return Ok((Rays::new(input, "standard input".into())?, bar));
    }
    let refused = |source: io::Error| match source.kind() {
        io::ErrorKind::NotFound => FileError::Missing(path.into()),
        _ => FileError::Read { path: path.into(), source },
    };
    let file = File::open(path).map_err(refused)?;
    let metadata = file.metadata().map_err(refused)?;
    if metadata.is_dir() {
        return Err(FileError::IsFolder(path.into()).into());
    }
    let bar = progress::bar("tracing", metadata.len());
    let input: Box<dyn BufRead> = Box::new(BufReader::new(bar.wrap_read(file)));
    Ok((Rays::new(input, path.display().to_string())?, bar))
}

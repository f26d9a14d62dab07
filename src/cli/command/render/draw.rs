//! Drawing with threads, a bar, and an end by Ctrl-C.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use miette::miette;

use crate::cli::progress::bar;
use crate::cli::scene_source::no_picture;
use crate::simulate::document::Resolved;
use crate::simulate::{Choice, Kept, Layer, Picture, Watch};

/// Most numbers of a picture: 8 GiB, and as much again while it is put together.
const MOST_NUMBERS: usize = 1 << 31;
/// How often the bar is told.
const LOOK: Duration = Duration::from_millis(100);

pub(super) fn draw(
    place: &str,
    resolved: &Resolved,
    choice: &Choice,
    layers: &[Layer],
    threads: Option<u16>,
) -> Result<Picture, miette::Report> {
    let scene = &resolved.scene;
    let channels = if resolved.kept == Kept::Spectra { scene.grid.nm().len() } else { 3 };
    let numbers = (scene.size.0 * scene.size.1).saturating_mul(layers.len() * channels + 1);
    if numbers > MOST_NUMBERS {
        return Err(miette!(
            help = "draw fewer layers (--layers total), fewer pixels, colours instead of spectra, or larger steps of the wavelength",
            "{place}: found a picture of {numbers} numbers ({} layers of {channels} channels); expected at most {MOST_NUMBERS}",
            layers.len()
        ));
    }
    let threads = threads.map_or(0, usize::from);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| miette!("{threads} threads cannot be started: {error}"))?;
    let watch = Arc::new(Watch::default());
    cancel_by_ctrl_c(&watch);
    let is_done = AtomicBool::new(false);
    let drawn = std::thread::scope(|threads| {
        let _bar = threads.spawn(|| follow(&watch, &is_done, scene.size.1));
        let drawn = pool.install(|| Picture::draw(scene, choice, resolved.kept, layers, &watch));
        is_done.store(true, Ordering::Relaxed);
        drawn
    });
    drawn.map_err(|why| no_picture(place, resolved, &why))
}

fn follow(watch: &Watch, is_done: &AtomicBool, rows: usize) {
    let bar = bar(rows as u64, "rows");
    while !is_done.load(Ordering::Relaxed) {
        bar.set_position(watch.rows.load(Ordering::Relaxed) as u64);
        std::thread::sleep(LOOK);
    }
    bar.finish_and_clear();
}

/// The first Ctrl-C ends the work between two pixels rows, or lets the writing of files come to its end; the second ends the process.
fn cancel_by_ctrl_c(watch: &Arc<Watch>) {
    let watch = Arc::clone(watch);
    // Where there can be no handler the system ends the process, as without one.
    let _ = ctrlc::set_handler(move || {
        if watch.is_cancelled.swap(true, Ordering::Relaxed) {
            std::process::exit(2);
        }
    });
}

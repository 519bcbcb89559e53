//! The table of everything that is measured.

use crate::ours::{Coverage, Frame, RASTERIZERS, Threads};
use crate::scenes::Scene;
use crate::{euc, osmesa, retrofire};

/// The name of the peer that all are compared with.
pub(crate) const REFERENCE: &str = "llvmpipe";

/// A renderer.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Peer {
    pub(crate) name: &'static str,
    pub(crate) threads: Threads,
    pub(crate) coverage: Coverage,
}

impl Peer {
    const fn new(name: &'static str, threads: Threads, coverage: Coverage) -> Self {
        Self { name, threads, coverage }
    }
}

/// Our own.
pub(crate) fn ours() -> impl Iterator<Item = Peer> {
    RASTERIZERS.iter().map(|ours| Peer::new(ours.name, ours.threads, ours.coverage))
}

/// All renderers, ours first.
pub(crate) fn all() -> Vec<Peer> {
    let others = [
        Peer::new("euc", Threads::One, Coverage::Near),
        Peer::new("retrofire-core", Threads::One, Coverage::Near),
        Peer::new(REFERENCE, Threads::Many, Coverage::Exact),
        Peer::new("llvmpipe + read", Threads::Many, Coverage::Exact),
    ];
    ours().chain(others).collect()
}

/// Makes a scene ready to be drawn by the renderer of this name.
pub(crate) fn prepare(name: &str, scene: Scene) -> Result<Box<dyn Frame>, String> {
    match name {
        "euc" => Ok(euc::prepare(scene)),
        "retrofire-core" => Ok(retrofire::prepare(scene)),
        REFERENCE => osmesa::prepare(scene),
        "llvmpipe + read" => osmesa::prepare_read_back(scene),
        _ => match RASTERIZERS.iter().find(|ours| ours.name == name) {
            Some(ours) => Ok((ours.prepare)(scene)),
            None => Err(format!("no renderer is called {name}")),
        },
    }
}

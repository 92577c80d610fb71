//! A board as an argument.

use clap::builder::{PossibleValuesParser, TypedValueParser};
use firmware_rt::board::{BOARDS, Board, by_name};

/// Boards by their names, which help and errors list.
pub(super) fn named() -> impl TypedValueParser<Value = &'static Board> {
    PossibleValuesParser::new(BOARDS.map(|board| board.name)).try_map(|name| by_name(&name).ok_or("no such board"))
}

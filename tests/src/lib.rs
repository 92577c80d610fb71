//! Oracles and helpers that the tests share. Nothing here calls the code that it checks.

//! Writers, one format a file.

mod glb_container;

pub fn read(
    _: &std::path::Path,
    _: &[u8],
    _: &super::ImportOptions,
) -> Result<isolux_core::scene::Scene, crate::Error> {
    Ok(Default::default())
}

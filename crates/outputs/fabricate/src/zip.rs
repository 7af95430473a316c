//! A zip archive of uncompressed files, after PKWARE's APPNOTE 6.3.3.

/// The first day that the format knows, 1 January 1980, instead of today.
const DATE: u16 = (1 << 5) | 1;

/// The archive. Names are ASCII; all together stays far below the 4 GiB that the plain format holds.
pub(crate) fn stored(files: &[(&str, &[u8])]) -> Vec<u8> {
    let (mut out, mut directory) = (Vec::new(), Vec::new());
    for (name, bytes) in files {
        let offset = size(&out);
        // Version 2.0 to extract, no flags, stored.
        let mut entry: Vec<u8> = [20_u16, 0, 0, 0, DATE].into_iter().flat_map(u16::to_le_bytes).collect();
        entry.extend([crc32(bytes), size(bytes), size(bytes)].into_iter().flat_map(u32::to_le_bytes));
        entry.extend([short(name.len()), 0].into_iter().flat_map(u16::to_le_bytes));
        out.extend(b"PK\x03\x04");
        out.extend(&entry);
        out.extend(name.bytes());
        out.extend(*bytes);
        directory.extend(b"PK\x01\x02\x14\x00");
        directory.extend(&entry);
        // No comment, first disk, no attributes.
        directory.extend([0; 10]);
        directory.extend(offset.to_le_bytes());
        directory.extend(name.bytes());
    }
    let offset = size(&out);
    out.extend(&directory);
    out.extend(b"PK\x05\x06");
    out.extend([0, 0, short(files.len()), short(files.len())].into_iter().flat_map(u16::to_le_bytes));
    out.extend(size(&directory).to_le_bytes());
    out.extend(offset.to_le_bytes());
    out.extend([0; 2]);
    out
}

fn size(bytes: &[u8]) -> u32 {
    u32::try_from(bytes.len()).unwrap_or(u32::MAX)
}

fn short(count: usize) -> u16 {
    u16::try_from(count).unwrap_or(u16::MAX)
}

/// The checksum of ISO 3309, bit by bit.
fn crc32(bytes: &[u8]) -> u32 {
    let step = |crc: u32| if crc & 1 == 1 { (crc >> 1) ^ 0xedb8_8320 } else { crc >> 1 };
    let byte = |crc: u32, byte: &u8| (0..8).fold(crc ^ u32::from(*byte), |crc, _| step(crc));
    !bytes.iter().fold(!0, byte)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_is_the_published_one() {
        // The check value of CRC-32/ISO-HDLC.
        assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
        assert_eq!(crc32(b""), 0);
    }
}

//! Checksums that are right again after an edit, so that what is behind them is read.

use crate::edits::Edit;

/// Magic, version.
const HEAD: usize = 12;

/// Whether an edit of a checkpoint is one of the state: most are.
pub fn is_of_state(edit: Edit) -> bool {
    edit.part % 16 > 1
}

/// A checkpoint with edits: what it says of itself and the state are edited by themselves, and both checksums are right.
///
/// It is: magic, version, length of the description (8 bytes), description, state, CRC-32 of all before; the state itself is: magic,
/// version, fingerprint (8 bytes), numbers, CRC-32.
pub fn checkpoint(whole: &[u8], edits: &[Edit]) -> Vec<u8> {
    let body = &whole[..whole.len() - 4];
    let length = u64::from_le_bytes(body[HEAD..HEAD + 8].try_into().expect("eight bytes")) as usize;
    let (mut description, state) = (body[HEAD + 8..HEAD + 8 + length].to_vec(), &body[HEAD + 8 + length..]);
    let (state_head, numbers) = state[..state.len() - 4].split_at(HEAD + 8);
    let (mut head, mut numbers) = (body[..HEAD].to_vec(), numbers.to_vec());
    for edit in edits {
        edit.apply(match edit.part % 16 {
            0 if edit.at % 8 == 0 => &mut head,
            0 | 1 => &mut description,
            _ => &mut numbers,
        });
    }
    let state = summed([state_head, &numbers].concat());
    let length = (description.len() as u64).to_le_bytes();
    summed([&head[..], &length, &description, &state].concat())
}

/// A log with edits: each of its blocks is edited by itself, and has its length and checksum.
///
/// It is: magic, version, and blocks of length (8 bytes), CRC-32, content.
pub fn log(whole: &[u8], edits: &[Edit]) -> Vec<u8> {
    let mut blocks = vec![whole[..HEAD].to_vec()];
    let mut rest = &whole[HEAD..];
    while let Some((length, after)) = rest.split_first_chunk::<8>() {
        let content = &after[4..4 + u64::from_le_bytes(*length) as usize];
        blocks.push(content.to_vec());
        rest = &after[4 + content.len()..];
    }
    for edit in edits {
        let number = blocks.len();
        // The first block says whose log it is, and ends the reading where it is wrong: mostly frames are edited.
        edit.apply(
            &mut blocks[if edit.part % 16 < 2 { usize::from(edit.part % 2) } else { edit.part as usize % number }],
        );
    }
    let mut log = blocks[0].clone();
    for content in &blocks[1..] {
        log.extend_from_slice(&(content.len() as u64).to_le_bytes());
        log.extend_from_slice(&crc32fast::hash(content).to_le_bytes());
        log.extend_from_slice(content);
    }
    log
}

fn summed(mut bytes: Vec<u8>) -> Vec<u8> {
    let sum = crc32fast::hash(&bytes).to_le_bytes();
    bytes.extend_from_slice(&sum);
    bytes
}

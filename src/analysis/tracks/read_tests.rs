//! What is read of files with tracks, and what is said of those that are wrong.

use super::*;

fn read(text: &str) -> Read {
    parse("t.csv", text, &Options::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn faults(text: &str, options: &Options) -> Vec<Fault> {
    let Err(Error::Input(faults)) = parse("t.csv", text, options) else { panic!("no faults in {text:?}") };
    faults
}

const PLAIN: &str =
    "TRACK_ID,FRAME,POSITION_T,POSITION_X,POSITION_Y\n7,0,0,1,2\nleft,1,30,5,6\n7,1,30,1.5,2\n7,3,90,2,2\n";

#[test]
fn tracks_stand_on_the_frames_that_there_are() {
    let Read { tracks, notes } = read(PLAIN);
    assert_eq!(
        (tracks.times.as_slice(), tracks.names.as_slice()),
        ([0.0, 30.0, 90.0].as_slice(), ["7".to_owned(), "left".to_owned()].as_slice())
    );
    assert_eq!(tracks.axes(), 2);
    assert_eq!(tracks.position(1, 0), [1.5, 2.0, 0.0]);
    assert_eq!(tracks.frames_of(1).collect::<Vec<_>>(), [1]);
    assert_eq!(notes.len(), 2, "{notes:?}");
}

#[test]
fn what_trackmate_writes_is_read_with_its_units() {
    let text = "LABEL,ID,TRACK_ID,QUALITY,POSITION_X,POSITION_Y,POSITION_Z,POSITION_T,FRAME\n\
                Label,Spot ID,Track ID,Quality,X,Y,Z,T,Frame\n\
                Label,Spot ID,Track ID,Quality,X,Y,Z,T,Frame\n\
                ,,,(quality),(mm),(mm),(mm),(minutes),\n\
                ID1,1,0,9.5,0.001,0.002,0,0,0\n\
                ID2,2,0,9.5,0.002,0.002,0,0.5,1\n\
                ID3,3,,9.5,0.5,0.5,0,0.5,1\n";
    let Read { tracks, notes } = read(text);
    assert_eq!(tracks.times, [0.0, 30.0]);
    assert_eq!(tracks.position(1, 0), [2.0, 2.0, 0.0]);
    assert_eq!(notes, ["1 row without a track, passed over"]);
    let micron = parse("t.csv", &text.replace("(mm)", "(micron)").replace("(minutes)", "(sec)"), &Options::default());
    assert_eq!(micron.unwrap().tracks.times, [0.0, 0.5]);
    let pixels = text.replace("(mm)", "(pixel)");
    assert!(faults(&pixels, &Options::default())[0].help.as_ref().unwrap().contains("--length-unit"));
    let options = Options { length_unit: Some(0.5), ..Options::default() };
    assert_eq!(parse("t.csv", &pixels, &options).unwrap().tracks.position(1, 0), [0.001, 0.001, 0.0]);
}

#[test]
fn other_columns_signs_and_films_without_times_are_read_when_they_are_named() {
    let text = "cell;x;y;when\n1;3;4;0\n1;6;8;1\n";
    let options = Options {
        columns: Some(["cell", "when", "x", "y"].map(str::to_owned).to_vec()),
        time_unit: Some(60.0),
        ..Options::default()
    };
    let read = parse("t.csv", text, &options).unwrap();
    assert_eq!((read.tracks.times.as_slice(), read.tracks.position(1, 0)), ([0.0, 60.0].as_slice(), [6.0, 8.0, 0.0]));
    let film = "TRACK_ID\tFRAME\tPOSITION_X\tPOSITION_Y\n1\t4\t0\t0\n1\t6\t1\t1\n";
    let options = Options { interval: Some(10.0), ..Options::default() };
    assert_eq!(parse("t.csv", film, &options).unwrap().tracks.times, [40.0, 60.0]);
    assert!(faults(film, &Options::default())[0].help.as_ref().unwrap().contains("--interval"));
}

#[test]
fn wrong_rows_are_pointed_at() {
    let messages = |text: &str| -> Vec<String> {
        faults(text, &Options::default()).into_iter().map(|fault| fault.message).collect()
    };
    let with = |row: &str| format!("{PLAIN}{row}\n");
    assert_eq!(messages(&with("7,4,120,3,two")), ["\"two\" is not a number"]);
    assert_eq!(messages(&with("7,3,90,3,3")), ["track 7 has two positions at 90 s"]);
    assert_eq!(messages(&with("8,3,95,3,3")), ["frame 3 has the times 90 s and 95 s"]);
    assert_eq!(messages(&with("8,4,80,3,3")), ["frame 3 is at 90 s, and 4 at 80 s"]);
    assert_eq!(messages(&with("8,4,120,3")), ["a row of 4 fields under 5 column names"]);
    assert_eq!(messages(&with("8,,120,3,4")), ["a position of track 8 has no time"]);
    assert_eq!(messages(""), ["t.csv is empty"]);
    assert_eq!(messages(PLAIN.lines().next().unwrap()), ["t.csv has no positions of tracks"]);
    assert_eq!(messages(&PLAIN.replace("POSITION_X", "POSITION_x_um")), ["there is no column \"POSITION_X\" in t.csv"]);
    assert_eq!(
        faults(&"7,0,0,a,b\n".repeat(30).replacen("7,0,0,a,b", PLAIN.trim_end(), 1), &Options::default()).len(),
        MOST_FAULTS
    );
}

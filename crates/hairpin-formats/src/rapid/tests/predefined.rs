//! Predefined data wherever a value may stand.

use hairpin::trajectory::program::{Speed, Tool, Zone};

use super::{assert_clear, inside, unclear};

const P: &str = "CONST robtarget p:=[[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];";

#[test]
fn it_is_declared_with_assigned_handed_over_and_taken_apart() {
    let module = inside(&format!(
        "{P}\nCONST speeddata slow:=v200;\nCONST zonedata near:=z10;\nPERS tooldata t:=tool0;\nPERS wobjdata w:=wobj0;\n\
         CONST speeddata steps{{2}}:=[v100,V300];\nCONST speeddata other:=[v50.v_tcp,v50.v_ori,0,z5.pzone_tcp];\n\
         CONST speeddata fast:=vmax;\n\
         PROC main()\nVAR speeddata v;\nVAR num i:=2;\nMoveL p,slow,near,t\\WObj:=w;\nMoveL p,steps{{i}},fine,tool0;\n\
         v:=v80;\nv.v_tcp:=v.v_tcp/2;\nMoveL p,v,z0,t;\ngo v150,z1;\nMoveL p,pick(TRUE),fine,tool0;\nMoveL p,other,fine,t;\n\
         t:=tool0;\nMoveL p,fast,fine,t\\TLoad:=load0;\nENDPROC\n\
         PROC go(speeddata how,zonedata when)\nMoveL p,how,when,tool0;\nENDPROC\n\
         FUNC speeddata pick(bool quick)\nIF quick RETURN v1000;\nRETURN v10;\nENDFUNC"
    ));
    assert_clear(&module);
    let moves = &module.program.moves;
    let tcp: Vec<i64> = moves[..6].iter().map(|m| (m.speed.tcp * 1e6).round() as i64).collect();
    assert_eq!(tcp, [200_000, 300_000, 40_000, 150_000, 1_000_000, 50_000]);
    assert!(moves[0].speed.same_as(&Speed::predefined("v200").unwrap()));
    assert_eq!(moves[0].speed.name.as_deref(), Some("slow"));
    assert!(moves[0].zone.same_as(&Zone::predefined("z10").unwrap()));
    assert!(moves[3].zone.same_as(&Zone::predefined("z1").unwrap()));
    assert_eq!(moves[6].speed, Speed::predefined("vmax").unwrap());
    let tool = &module.program.tools[moves[0].tool];
    assert_eq!((tool.tcp, tool.mass), (Tool::flange().tcp, Tool::flange().mass));
}

#[test]
fn what_the_file_declares_goes_before_it() {
    let module = inside(&format!(
        "{P}\nCONST speeddata v200:=[70,500,5000,1000];\nPROC main()\nMoveL p,v200,fine,tool0;\nENDPROC"
    ));
    assert_clear(&module);
    assert_eq!(module.program.moves[0].speed.tcp, 0.07);
    for (body, words) in [
        ("MoveL p,z10,fine,tool0;", "`z10` is no speeddata"),
        ("MoveL p,v10,v10,tool0;", "`v10` is no zonedata"),
        ("MoveL v10,v10,fine,tool0;", "`v10` is no robtarget"),
        ("MoveL p,[vmax.v_tcp/2,1,1,1],fine,tool0;", "not known"),
        ("MoveL p,v55,fine,tool0;", "`v55` is not declared"),
    ] {
        let module = inside(&format!("{P}\nPROC main()\n{body}\nENDPROC"));
        assert!(unclear(&module).1.contains(words), "{body}: {:?}", unclear(&module));
    }
}

<?xml version="1.0"?>
<!-- A block of 64 hexahedra whose inner atoms have been moved about, to test that a homogeneous deformation is one on any mesh. -->
<physicalModel name="irregular block">
<atoms><structuralComponent name="atoms">
<atom><atomProperties index="0" x="-2.0000" y="-2.0000" z="-2.0000"/></atom>
<atom><atomProperties index="1" x="-1.0000" y="-2.0000" z="-2.0000"/></atom>
<atom><atomProperties index="2" x="0.0000" y="-2.0000" z="-2.0000"/></atom>
<atom><atomProperties index="3" x="1.0000" y="-2.0000" z="-2.0000"/></atom>
<atom><atomProperties index="4" x="2.0000" y="-2.0000" z="-2.0000"/></atom>
<atom><atomProperties index="5" x="-2.0000" y="-1.0000" z="-2.0000"/></atom>
<atom><atomProperties index="6" x="-1.0000" y="-1.0000" z="-2.0000"/></atom>
<atom><atomProperties index="7" x="0.0000" y="-1.0000" z="-2.0000"/></atom>
<atom><atomProperties index="8" x="1.0000" y="-1.0000" z="-2.0000"/></atom>
<atom><atomProperties index="9" x="2.0000" y="-1.0000" z="-2.0000"/></atom>
<atom><atomProperties index="10" x="-2.0000" y="0.0000" z="-2.0000"/></atom>
<atom><atomProperties index="11" x="-1.0000" y="0.0000" z="-2.0000"/></atom>
<atom><atomProperties index="12" x="0.0000" y="0.0000" z="-2.0000"/></atom>
<atom><atomProperties index="13" x="1.0000" y="0.0000" z="-2.0000"/></atom>
<atom><atomProperties index="14" x="2.0000" y="0.0000" z="-2.0000"/></atom>
<atom><atomProperties index="15" x="-2.0000" y="1.0000" z="-2.0000"/></atom>
<atom><atomProperties index="16" x="-1.0000" y="1.0000" z="-2.0000"/></atom>
<atom><atomProperties index="17" x="0.0000" y="1.0000" z="-2.0000"/></atom>
<atom><atomProperties index="18" x="1.0000" y="1.0000" z="-2.0000"/></atom>
<atom><atomProperties index="19" x="2.0000" y="1.0000" z="-2.0000"/></atom>
<atom><atomProperties index="20" x="-2.0000" y="2.0000" z="-2.0000"/></atom>
<atom><atomProperties index="21" x="-1.0000" y="2.0000" z="-2.0000"/></atom>
<atom><atomProperties index="22" x="0.0000" y="2.0000" z="-2.0000"/></atom>
<atom><atomProperties index="23" x="1.0000" y="2.0000" z="-2.0000"/></atom>
<atom><atomProperties index="24" x="2.0000" y="2.0000" z="-2.0000"/></atom>
<atom><atomProperties index="25" x="-2.0000" y="-2.0000" z="-1.0000"/></atom>
<atom><atomProperties index="26" x="-1.0000" y="-2.0000" z="-1.0000"/></atom>
<atom><atomProperties index="27" x="0.0000" y="-2.0000" z="-1.0000"/></atom>
<atom><atomProperties index="28" x="1.0000" y="-2.0000" z="-1.0000"/></atom>
<atom><atomProperties index="29" x="2.0000" y="-2.0000" z="-1.0000"/></atom>
<atom><atomProperties index="30" x="-2.0000" y="-1.0000" z="-1.0000"/></atom>
<atom><atomProperties index="31" x="-1.0027" y="-1.1569" z="-0.9289"/></atom>
<atom><atomProperties index="32" x="-0.1813" y="-0.9909" z="-0.8328"/></atom>
<atom><atomProperties index="33" x="1.0499" y="-0.9248" z="-0.8862"/></atom>
<atom><atomProperties index="34" x="2.0000" y="-1.0000" z="-1.0000"/></atom>
<atom><atomProperties index="35" x="-2.0000" y="0.0000" z="-1.0000"/></atom>
<atom><atomProperties index="36" x="-0.9913" y="-0.0811" z="-1.0100"/></atom>
<atom><atomProperties index="37" x="0.1722" y="-0.2466" z="-0.8711"/></atom>
<atom><atomProperties index="38" x="0.9110" y="-0.1350" z="-0.8177"/></atom>
<atom><atomProperties index="39" x="2.0000" y="0.0000" z="-1.0000"/></atom>
<atom><atomProperties index="40" x="-2.0000" y="1.0000" z="-1.0000"/></atom>
<atom><atomProperties index="41" x="-0.8926" y="0.9669" z="-1.1993"/></atom>
<atom><atomProperties index="42" x="0.2163" y="0.8187" z="-1.1164"/></atom>
<atom><atomProperties index="43" x="0.8247" y="1.0596" z="-0.7608"/></atom>
<atom><atomProperties index="44" x="2.0000" y="1.0000" z="-1.0000"/></atom>
<atom><atomProperties index="45" x="-2.0000" y="2.0000" z="-1.0000"/></atom>
<atom><atomProperties index="46" x="-1.0000" y="2.0000" z="-1.0000"/></atom>
<atom><atomProperties index="47" x="0.0000" y="2.0000" z="-1.0000"/></atom>
<atom><atomProperties index="48" x="1.0000" y="2.0000" z="-1.0000"/></atom>
<atom><atomProperties index="49" x="2.0000" y="2.0000" z="-1.0000"/></atom>
<atom><atomProperties index="50" x="-2.0000" y="-2.0000" z="0.0000"/></atom>
<atom><atomProperties index="51" x="-1.0000" y="-2.0000" z="0.0000"/></atom>
<atom><atomProperties index="52" x="0.0000" y="-2.0000" z="0.0000"/></atom>
<atom><atomProperties index="53" x="1.0000" y="-2.0000" z="0.0000"/></atom>
<atom><atomProperties index="54" x="2.0000" y="-2.0000" z="0.0000"/></atom>
<atom><atomProperties index="55" x="-2.0000" y="-1.0000" z="0.0000"/></atom>
<atom><atomProperties index="56" x="-0.8862" y="-1.1836" z="-0.1475"/></atom>
<atom><atomProperties index="57" x="-0.2042" y="-1.0320" z="0.1230"/></atom>
<atom><atomProperties index="58" x="1.1026" y="-1.0725" z="0.0811"/></atom>
<atom><atomProperties index="59" x="2.0000" y="-1.0000" z="0.0000"/></atom>
<atom><atomProperties index="60" x="-2.0000" y="0.0000" z="0.0000"/></atom>
<atom><atomProperties index="61" x="-0.8858" y="-0.0142" z="-0.2101"/></atom>
<atom><atomProperties index="62" x="-0.1009" y="0.1882" z="0.0474"/></atom>
<atom><atomProperties index="63" x="0.7617" y="0.1238" z="-0.1085"/></atom>
<atom><atomProperties index="64" x="2.0000" y="0.0000" z="0.0000"/></atom>
<atom><atomProperties index="65" x="-2.0000" y="1.0000" z="0.0000"/></atom>
<atom><atomProperties index="66" x="-1.0456" y="1.2147" z="0.0313"/></atom>
<atom><atomProperties index="67" x="-0.1089" y="0.7695" z="-0.2420"/></atom>
<atom><atomProperties index="68" x="0.9781" y="1.0893" z="-0.2137"/></atom>
<atom><atomProperties index="69" x="2.0000" y="1.0000" z="0.0000"/></atom>
<atom><atomProperties index="70" x="-2.0000" y="2.0000" z="0.0000"/></atom>
<atom><atomProperties index="71" x="-1.0000" y="2.0000" z="0.0000"/></atom>
<atom><atomProperties index="72" x="0.0000" y="2.0000" z="0.0000"/></atom>
<atom><atomProperties index="73" x="1.0000" y="2.0000" z="0.0000"/></atom>
<atom><atomProperties index="74" x="2.0000" y="2.0000" z="0.0000"/></atom>
<atom><atomProperties index="75" x="-2.0000" y="-2.0000" z="1.0000"/></atom>
<atom><atomProperties index="76" x="-1.0000" y="-2.0000" z="1.0000"/></atom>
<atom><atomProperties index="77" x="0.0000" y="-2.0000" z="1.0000"/></atom>
<atom><atomProperties index="78" x="1.0000" y="-2.0000" z="1.0000"/></atom>
<atom><atomProperties index="79" x="2.0000" y="-2.0000" z="1.0000"/></atom>
<atom><atomProperties index="80" x="-2.0000" y="-1.0000" z="1.0000"/></atom>
<atom><atomProperties index="81" x="-0.9373" y="-1.1080" z="0.9017"/></atom>
<atom><atomProperties index="82" x="0.1902" y="-1.2138" z="1.1298"/></atom>
<atom><atomProperties index="83" x="0.8720" y="-0.8461" z="1.0729"/></atom>
<atom><atomProperties index="84" x="2.0000" y="-1.0000" z="1.0000"/></atom>
<atom><atomProperties index="85" x="-2.0000" y="0.0000" z="1.0000"/></atom>
<atom><atomProperties index="86" x="-1.0226" y="0.1154" z="1.0624"/></atom>
<atom><atomProperties index="87" x="0.0348" y="0.2431" z="0.9411"/></atom>
<atom><atomProperties index="88" x="0.9180" y="0.0028" z="1.1644"/></atom>
<atom><atomProperties index="89" x="2.0000" y="0.0000" z="1.0000"/></atom>
<atom><atomProperties index="90" x="-2.0000" y="1.0000" z="1.0000"/></atom>
<atom><atomProperties index="91" x="-1.1313" y="1.2467" z="0.8244"/></atom>
<atom><atomProperties index="92" x="-0.0055" y="0.8248" z="0.8798"/></atom>
<atom><atomProperties index="93" x="1.1705" y="1.1646" z="1.1772"/></atom>
<atom><atomProperties index="94" x="2.0000" y="1.0000" z="1.0000"/></atom>
<atom><atomProperties index="95" x="-2.0000" y="2.0000" z="1.0000"/></atom>
<atom><atomProperties index="96" x="-1.0000" y="2.0000" z="1.0000"/></atom>
<atom><atomProperties index="97" x="0.0000" y="2.0000" z="1.0000"/></atom>
<atom><atomProperties index="98" x="1.0000" y="2.0000" z="1.0000"/></atom>
<atom><atomProperties index="99" x="2.0000" y="2.0000" z="1.0000"/></atom>
<atom><atomProperties index="100" x="-2.0000" y="-2.0000" z="2.0000"/></atom>
<atom><atomProperties index="101" x="-1.0000" y="-2.0000" z="2.0000"/></atom>
<atom><atomProperties index="102" x="0.0000" y="-2.0000" z="2.0000"/></atom>
<atom><atomProperties index="103" x="1.0000" y="-2.0000" z="2.0000"/></atom>
<atom><atomProperties index="104" x="2.0000" y="-2.0000" z="2.0000"/></atom>
<atom><atomProperties index="105" x="-2.0000" y="-1.0000" z="2.0000"/></atom>
<atom><atomProperties index="106" x="-1.0000" y="-1.0000" z="2.0000"/></atom>
<atom><atomProperties index="107" x="0.0000" y="-1.0000" z="2.0000"/></atom>
<atom><atomProperties index="108" x="1.0000" y="-1.0000" z="2.0000"/></atom>
<atom><atomProperties index="109" x="2.0000" y="-1.0000" z="2.0000"/></atom>
<atom><atomProperties index="110" x="-2.0000" y="0.0000" z="2.0000"/></atom>
<atom><atomProperties index="111" x="-1.0000" y="0.0000" z="2.0000"/></atom>
<atom><atomProperties index="112" x="0.0000" y="0.0000" z="2.0000"/></atom>
<atom><atomProperties index="113" x="1.0000" y="0.0000" z="2.0000"/></atom>
<atom><atomProperties index="114" x="2.0000" y="0.0000" z="2.0000"/></atom>
<atom><atomProperties index="115" x="-2.0000" y="1.0000" z="2.0000"/></atom>
<atom><atomProperties index="116" x="-1.0000" y="1.0000" z="2.0000"/></atom>
<atom><atomProperties index="117" x="0.0000" y="1.0000" z="2.0000"/></atom>
<atom><atomProperties index="118" x="1.0000" y="1.0000" z="2.0000"/></atom>
<atom><atomProperties index="119" x="2.0000" y="1.0000" z="2.0000"/></atom>
<atom><atomProperties index="120" x="-2.0000" y="2.0000" z="2.0000"/></atom>
<atom><atomProperties index="121" x="-1.0000" y="2.0000" z="2.0000"/></atom>
<atom><atomProperties index="122" x="0.0000" y="2.0000" z="2.0000"/></atom>
<atom><atomProperties index="123" x="1.0000" y="2.0000" z="2.0000"/></atom>
<atom><atomProperties index="124" x="2.0000" y="2.0000" z="2.0000"/></atom>
</structuralComponent></atoms>
<exclusiveComponents><multiComponent name="all"><structuralComponent name="elements">
<cell><cellProperties type="HEXAHEDRON" index="0"/><atomRef index="0"/><atomRef index="1"/><atomRef index="6"/><atomRef index="5"/><atomRef index="25"/><atomRef index="26"/><atomRef index="31"/><atomRef index="30"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="1"/><atomRef index="1"/><atomRef index="2"/><atomRef index="7"/><atomRef index="6"/><atomRef index="26"/><atomRef index="27"/><atomRef index="32"/><atomRef index="31"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="2"/><atomRef index="2"/><atomRef index="3"/><atomRef index="8"/><atomRef index="7"/><atomRef index="27"/><atomRef index="28"/><atomRef index="33"/><atomRef index="32"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="3"/><atomRef index="3"/><atomRef index="4"/><atomRef index="9"/><atomRef index="8"/><atomRef index="28"/><atomRef index="29"/><atomRef index="34"/><atomRef index="33"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="4"/><atomRef index="5"/><atomRef index="6"/><atomRef index="11"/><atomRef index="10"/><atomRef index="30"/><atomRef index="31"/><atomRef index="36"/><atomRef index="35"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="5"/><atomRef index="6"/><atomRef index="7"/><atomRef index="12"/><atomRef index="11"/><atomRef index="31"/><atomRef index="32"/><atomRef index="37"/><atomRef index="36"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="6"/><atomRef index="7"/><atomRef index="8"/><atomRef index="13"/><atomRef index="12"/><atomRef index="32"/><atomRef index="33"/><atomRef index="38"/><atomRef index="37"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="7"/><atomRef index="8"/><atomRef index="9"/><atomRef index="14"/><atomRef index="13"/><atomRef index="33"/><atomRef index="34"/><atomRef index="39"/><atomRef index="38"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="8"/><atomRef index="10"/><atomRef index="11"/><atomRef index="16"/><atomRef index="15"/><atomRef index="35"/><atomRef index="36"/><atomRef index="41"/><atomRef index="40"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="9"/><atomRef index="11"/><atomRef index="12"/><atomRef index="17"/><atomRef index="16"/><atomRef index="36"/><atomRef index="37"/><atomRef index="42"/><atomRef index="41"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="10"/><atomRef index="12"/><atomRef index="13"/><atomRef index="18"/><atomRef index="17"/><atomRef index="37"/><atomRef index="38"/><atomRef index="43"/><atomRef index="42"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="11"/><atomRef index="13"/><atomRef index="14"/><atomRef index="19"/><atomRef index="18"/><atomRef index="38"/><atomRef index="39"/><atomRef index="44"/><atomRef index="43"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="12"/><atomRef index="15"/><atomRef index="16"/><atomRef index="21"/><atomRef index="20"/><atomRef index="40"/><atomRef index="41"/><atomRef index="46"/><atomRef index="45"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="13"/><atomRef index="16"/><atomRef index="17"/><atomRef index="22"/><atomRef index="21"/><atomRef index="41"/><atomRef index="42"/><atomRef index="47"/><atomRef index="46"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="14"/><atomRef index="17"/><atomRef index="18"/><atomRef index="23"/><atomRef index="22"/><atomRef index="42"/><atomRef index="43"/><atomRef index="48"/><atomRef index="47"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="15"/><atomRef index="18"/><atomRef index="19"/><atomRef index="24"/><atomRef index="23"/><atomRef index="43"/><atomRef index="44"/><atomRef index="49"/><atomRef index="48"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="16"/><atomRef index="25"/><atomRef index="26"/><atomRef index="31"/><atomRef index="30"/><atomRef index="50"/><atomRef index="51"/><atomRef index="56"/><atomRef index="55"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="17"/><atomRef index="26"/><atomRef index="27"/><atomRef index="32"/><atomRef index="31"/><atomRef index="51"/><atomRef index="52"/><atomRef index="57"/><atomRef index="56"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="18"/><atomRef index="27"/><atomRef index="28"/><atomRef index="33"/><atomRef index="32"/><atomRef index="52"/><atomRef index="53"/><atomRef index="58"/><atomRef index="57"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="19"/><atomRef index="28"/><atomRef index="29"/><atomRef index="34"/><atomRef index="33"/><atomRef index="53"/><atomRef index="54"/><atomRef index="59"/><atomRef index="58"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="20"/><atomRef index="30"/><atomRef index="31"/><atomRef index="36"/><atomRef index="35"/><atomRef index="55"/><atomRef index="56"/><atomRef index="61"/><atomRef index="60"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="21"/><atomRef index="31"/><atomRef index="32"/><atomRef index="37"/><atomRef index="36"/><atomRef index="56"/><atomRef index="57"/><atomRef index="62"/><atomRef index="61"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="22"/><atomRef index="32"/><atomRef index="33"/><atomRef index="38"/><atomRef index="37"/><atomRef index="57"/><atomRef index="58"/><atomRef index="63"/><atomRef index="62"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="23"/><atomRef index="33"/><atomRef index="34"/><atomRef index="39"/><atomRef index="38"/><atomRef index="58"/><atomRef index="59"/><atomRef index="64"/><atomRef index="63"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="24"/><atomRef index="35"/><atomRef index="36"/><atomRef index="41"/><atomRef index="40"/><atomRef index="60"/><atomRef index="61"/><atomRef index="66"/><atomRef index="65"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="25"/><atomRef index="36"/><atomRef index="37"/><atomRef index="42"/><atomRef index="41"/><atomRef index="61"/><atomRef index="62"/><atomRef index="67"/><atomRef index="66"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="26"/><atomRef index="37"/><atomRef index="38"/><atomRef index="43"/><atomRef index="42"/><atomRef index="62"/><atomRef index="63"/><atomRef index="68"/><atomRef index="67"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="27"/><atomRef index="38"/><atomRef index="39"/><atomRef index="44"/><atomRef index="43"/><atomRef index="63"/><atomRef index="64"/><atomRef index="69"/><atomRef index="68"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="28"/><atomRef index="40"/><atomRef index="41"/><atomRef index="46"/><atomRef index="45"/><atomRef index="65"/><atomRef index="66"/><atomRef index="71"/><atomRef index="70"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="29"/><atomRef index="41"/><atomRef index="42"/><atomRef index="47"/><atomRef index="46"/><atomRef index="66"/><atomRef index="67"/><atomRef index="72"/><atomRef index="71"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="30"/><atomRef index="42"/><atomRef index="43"/><atomRef index="48"/><atomRef index="47"/><atomRef index="67"/><atomRef index="68"/><atomRef index="73"/><atomRef index="72"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="31"/><atomRef index="43"/><atomRef index="44"/><atomRef index="49"/><atomRef index="48"/><atomRef index="68"/><atomRef index="69"/><atomRef index="74"/><atomRef index="73"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="32"/><atomRef index="50"/><atomRef index="51"/><atomRef index="56"/><atomRef index="55"/><atomRef index="75"/><atomRef index="76"/><atomRef index="81"/><atomRef index="80"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="33"/><atomRef index="51"/><atomRef index="52"/><atomRef index="57"/><atomRef index="56"/><atomRef index="76"/><atomRef index="77"/><atomRef index="82"/><atomRef index="81"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="34"/><atomRef index="52"/><atomRef index="53"/><atomRef index="58"/><atomRef index="57"/><atomRef index="77"/><atomRef index="78"/><atomRef index="83"/><atomRef index="82"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="35"/><atomRef index="53"/><atomRef index="54"/><atomRef index="59"/><atomRef index="58"/><atomRef index="78"/><atomRef index="79"/><atomRef index="84"/><atomRef index="83"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="36"/><atomRef index="55"/><atomRef index="56"/><atomRef index="61"/><atomRef index="60"/><atomRef index="80"/><atomRef index="81"/><atomRef index="86"/><atomRef index="85"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="37"/><atomRef index="56"/><atomRef index="57"/><atomRef index="62"/><atomRef index="61"/><atomRef index="81"/><atomRef index="82"/><atomRef index="87"/><atomRef index="86"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="38"/><atomRef index="57"/><atomRef index="58"/><atomRef index="63"/><atomRef index="62"/><atomRef index="82"/><atomRef index="83"/><atomRef index="88"/><atomRef index="87"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="39"/><atomRef index="58"/><atomRef index="59"/><atomRef index="64"/><atomRef index="63"/><atomRef index="83"/><atomRef index="84"/><atomRef index="89"/><atomRef index="88"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="40"/><atomRef index="60"/><atomRef index="61"/><atomRef index="66"/><atomRef index="65"/><atomRef index="85"/><atomRef index="86"/><atomRef index="91"/><atomRef index="90"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="41"/><atomRef index="61"/><atomRef index="62"/><atomRef index="67"/><atomRef index="66"/><atomRef index="86"/><atomRef index="87"/><atomRef index="92"/><atomRef index="91"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="42"/><atomRef index="62"/><atomRef index="63"/><atomRef index="68"/><atomRef index="67"/><atomRef index="87"/><atomRef index="88"/><atomRef index="93"/><atomRef index="92"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="43"/><atomRef index="63"/><atomRef index="64"/><atomRef index="69"/><atomRef index="68"/><atomRef index="88"/><atomRef index="89"/><atomRef index="94"/><atomRef index="93"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="44"/><atomRef index="65"/><atomRef index="66"/><atomRef index="71"/><atomRef index="70"/><atomRef index="90"/><atomRef index="91"/><atomRef index="96"/><atomRef index="95"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="45"/><atomRef index="66"/><atomRef index="67"/><atomRef index="72"/><atomRef index="71"/><atomRef index="91"/><atomRef index="92"/><atomRef index="97"/><atomRef index="96"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="46"/><atomRef index="67"/><atomRef index="68"/><atomRef index="73"/><atomRef index="72"/><atomRef index="92"/><atomRef index="93"/><atomRef index="98"/><atomRef index="97"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="47"/><atomRef index="68"/><atomRef index="69"/><atomRef index="74"/><atomRef index="73"/><atomRef index="93"/><atomRef index="94"/><atomRef index="99"/><atomRef index="98"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="48"/><atomRef index="75"/><atomRef index="76"/><atomRef index="81"/><atomRef index="80"/><atomRef index="100"/><atomRef index="101"/><atomRef index="106"/><atomRef index="105"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="49"/><atomRef index="76"/><atomRef index="77"/><atomRef index="82"/><atomRef index="81"/><atomRef index="101"/><atomRef index="102"/><atomRef index="107"/><atomRef index="106"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="50"/><atomRef index="77"/><atomRef index="78"/><atomRef index="83"/><atomRef index="82"/><atomRef index="102"/><atomRef index="103"/><atomRef index="108"/><atomRef index="107"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="51"/><atomRef index="78"/><atomRef index="79"/><atomRef index="84"/><atomRef index="83"/><atomRef index="103"/><atomRef index="104"/><atomRef index="109"/><atomRef index="108"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="52"/><atomRef index="80"/><atomRef index="81"/><atomRef index="86"/><atomRef index="85"/><atomRef index="105"/><atomRef index="106"/><atomRef index="111"/><atomRef index="110"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="53"/><atomRef index="81"/><atomRef index="82"/><atomRef index="87"/><atomRef index="86"/><atomRef index="106"/><atomRef index="107"/><atomRef index="112"/><atomRef index="111"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="54"/><atomRef index="82"/><atomRef index="83"/><atomRef index="88"/><atomRef index="87"/><atomRef index="107"/><atomRef index="108"/><atomRef index="113"/><atomRef index="112"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="55"/><atomRef index="83"/><atomRef index="84"/><atomRef index="89"/><atomRef index="88"/><atomRef index="108"/><atomRef index="109"/><atomRef index="114"/><atomRef index="113"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="56"/><atomRef index="85"/><atomRef index="86"/><atomRef index="91"/><atomRef index="90"/><atomRef index="110"/><atomRef index="111"/><atomRef index="116"/><atomRef index="115"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="57"/><atomRef index="86"/><atomRef index="87"/><atomRef index="92"/><atomRef index="91"/><atomRef index="111"/><atomRef index="112"/><atomRef index="117"/><atomRef index="116"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="58"/><atomRef index="87"/><atomRef index="88"/><atomRef index="93"/><atomRef index="92"/><atomRef index="112"/><atomRef index="113"/><atomRef index="118"/><atomRef index="117"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="59"/><atomRef index="88"/><atomRef index="89"/><atomRef index="94"/><atomRef index="93"/><atomRef index="113"/><atomRef index="114"/><atomRef index="119"/><atomRef index="118"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="60"/><atomRef index="90"/><atomRef index="91"/><atomRef index="96"/><atomRef index="95"/><atomRef index="115"/><atomRef index="116"/><atomRef index="121"/><atomRef index="120"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="61"/><atomRef index="91"/><atomRef index="92"/><atomRef index="97"/><atomRef index="96"/><atomRef index="116"/><atomRef index="117"/><atomRef index="122"/><atomRef index="121"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="62"/><atomRef index="92"/><atomRef index="93"/><atomRef index="98"/><atomRef index="97"/><atomRef index="117"/><atomRef index="118"/><atomRef index="123"/><atomRef index="122"/></cell>
<cell><cellProperties type="HEXAHEDRON" index="63"/><atomRef index="93"/><atomRef index="94"/><atomRef index="99"/><atomRef index="98"/><atomRef index="118"/><atomRef index="119"/><atomRef index="124"/><atomRef index="123"/></cell>
</structuralComponent></multiComponent></exclusiveComponents>
</physicalModel>

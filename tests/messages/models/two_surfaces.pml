<physicalModel name="test">
<atoms><structuralComponent name="atoms">
  <atom><atomProperties index="0" x="0" y="0" z="0"/></atom>
  <atom><atomProperties index="1" x="1" y="0" z="0"/></atom>
  <atom><atomProperties index="2" x="0" y="1" z="0"/></atom>
  <atom><atomProperties index="3" x="0" y="0" z="1"/></atom>
  <atom><atomProperties index="4" x="5" y="0" z="0"/></atom>
  <atom><atomProperties index="5" x="6" y="0" z="0"/></atom>
  <atom><atomProperties index="6" x="5" y="1" z="0"/></atom>
  <atom><atomProperties index="7" x="5" y="0" z="1"/></atom>
</structuralComponent></atoms>
<exclusiveComponents><multiComponent name="all">
<structuralComponent name="left ">
  <cell><cellProperties type="TRIANGLE"/><atomRef index="0"/><atomRef index="2"/><atomRef index="1"/></cell>
  <cell><cellProperties type="TRIANGLE"/><atomRef index="0"/><atomRef index="1"/><atomRef index="3"/></cell>
  <cell><cellProperties type="TRIANGLE"/><atomRef index="0"/><atomRef index="3"/><atomRef index="2"/></cell>
  <cell><cellProperties type="TRIANGLE"/><atomRef index="1"/><atomRef index="2"/><atomRef index="3"/></cell>
</structuralComponent>
<structuralComponent name="right">
  <cell><cellProperties type="TRIANGLE"/><atomRef index="4"/><atomRef index="6"/><atomRef index="5"/></cell>
  <cell><cellProperties type="TRIANGLE"/><atomRef index="4"/><atomRef index="5"/><atomRef index="7"/></cell>
  <cell><cellProperties type="TRIANGLE"/><atomRef index="4"/><atomRef index="7"/><atomRef index="6"/></cell>
  <cell><cellProperties type="TRIANGLE"/><atomRef index="5"/><atomRef index="6"/><atomRef index="7"/></cell>
</structuralComponent>
</multiComponent></exclusiveComponents>
</physicalModel>
